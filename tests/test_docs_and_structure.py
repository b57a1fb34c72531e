"""The project's own order: documents that lead somewhere, verbs that explain themselves, files one can read."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).parent.parent
LONGEST_FILE = 400
LONGEST_DECISION = 20
LONGEST_README_WORDS = 600
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)|(?:src|srcset|href)=\"([^\"]+)\"")
DECISION = re.compile(r"docs/decisions/(\d{4})")
# Spelled with brackets so that this file does not find itself.
MACHINE_PATH = re.compile(r"(^|[^\w.-])/([w]ork|[r]oot|[f]arm)/")
REGISTRY = re.compile(r'"[r]esolved": *"https?://|[i]ndex-url *=|[r]egistry *= *.?https?://')


def tracked(*patterns: str) -> list[Path]:
    listed = subprocess.run(["git", "ls-files", "-z", *patterns], cwd=CHECKOUT, capture_output=True, check=True).stdout
    paths = [CHECKOUT / name for name in listed.decode().split("\0") if name]
    return [path for path in paths if path.is_file()]


def verbs() -> dict[str, str]:
    """Every verb of the Makefile with its description ('' where it has none)."""
    makefile = (CHECKOUT / "Makefile").read_text()
    phony = re.search(r"^\.PHONY: (.*)$", makefile, re.MULTILINE)
    assert phony
    described = dict(re.findall(r"^([a-z-]+):.*?## (.+)$", makefile, re.MULTILINE))
    return {verb: described.get(verb, "") for verb in phony[1].split()}


def test_every_verb_is_described_and_bare_make_lists_it():
    listed = subprocess.run(["make"], cwd=CHECKOUT, capture_output=True, text=True, check=True).stdout
    for verb, description in verbs().items():
        assert description, verb
        assert re.search(rf"^make {verb} +{re.escape(description)}$", listed, re.MULTILINE), verb


@pytest.mark.parametrize("page", tracked("*.md"), ids=lambda page: str(page.relative_to(CHECKOUT)))
def test_every_link_of_a_page_leads_somewhere(page):
    for link in (first or second for first, second in LINK.findall(page.read_text(encoding="utf-8"))):
        target = link.partition("#")[0]
        if target and "://" not in link and not link.startswith("mailto:"):
            assert (page.parent / target).exists(), link


def test_every_decision_is_in_the_index():
    index = (CHECKOUT / "docs/decisions/README.md").read_text(encoding="utf-8")
    decisions = [path.name for path in (CHECKOUT / "docs/decisions").glob("[0-9]*.md")]
    assert decisions
    assert [name for name in decisions if f"({name})" not in index] == []


def test_a_decision_and_the_readme_are_short():
    lengths = {path: len(path.read_text().splitlines()) for path in (CHECKOUT / "docs/decisions").glob("[0-9]*.md")}
    assert {path.name for path, lines in lengths.items() if lines > LONGEST_DECISION} == set()
    assert len((CHECKOUT / "README.md").read_text(encoding="utf-8").split()) <= LONGEST_README_WORDS


def test_every_decision_that_code_speaks_of_is_there():
    spoken_of = {
        number
        for file in tracked("*.py", "*.js", "*.css", "*.asl", "*.toml", "Makefile")
        for number in DECISION.findall(file.read_text(encoding="utf-8"))
    }
    assert len(spoken_of) > 3
    assert spoken_of - {path.name[:4] for path in (CHECKOUT / "docs/decisions").glob("[0-9]*.md")} == set()


def test_every_page_of_the_documentation_is_reached_from_the_readme():
    reached, waiting = set(), [CHECKOUT / "README.md"]
    while waiting:
        page = waiting.pop()
        if page in reached:
            continue
        reached.add(page)
        for first, second in LINK.findall(page.read_text(encoding="utf-8")):
            target = (page.parent / (first or second).partition("#")[0]).resolve()
            waiting += [target] if target.suffix == ".md" and target.is_file() else []
    assert {str(page.relative_to(CHECKOUT)) for page in tracked("docs/*.md")} <= {
        str(page.relative_to(CHECKOUT)) for page in reached
    }


def test_no_file_names_a_machine_or_a_registry():
    found = []
    for path in tracked():
        text = path.read_bytes().decode("utf-8", errors="ignore")
        found += [f"{path.relative_to(CHECKOUT)}: {line.strip()}" for line in text.splitlines() if _names_a_place(line)]
    assert found == []


def _names_a_place(line: str) -> bool:
    return bool(MACHINE_PATH.search(line) or REGISTRY.search(line))


def test_a_file_can_be_read_in_one_sitting():
    lengths = {str(p.relative_to(CHECKOUT)): len(p.read_text(encoding="utf-8").splitlines()) for p in tracked("*.py")}
    assert {name for name, lines in lengths.items() if lines > LONGEST_FILE} == set()


def test_every_package_has_its_layers_written_down():
    """A module without a place in the order of its package must fail `make check`."""
    config = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["tool"]["importlinter"]
    layered = {c["containers"][0] for c in config["contracts"] if c.get("exhaustive") and len(c["containers"]) == 1}
    assert set(config["root_packages"]) <= layered


def test_each_package_says_to_start_at_a_file_that_is_there():
    starts = {
        package.parent / name
        for package in tracked("*/__init__.py")
        for line in re.findall(r"^Start at .*$", package.read_text(encoding="utf-8"), re.MULTILINE)
        for name in re.findall(r"`([\w/]+\.py)`", line)
    }
    assert len(starts) > 30
    assert [str(path) for path in starts if not path.is_file()] == []


def test_no_two_pictures_of_pages_are_the_same():
    """One that shows what another does has missed what it was taken for."""
    pictures = {path.name: path.read_bytes() for path in tracked("docs/pictures/pages/*.webp")}
    assert len(pictures) > 50
    assert len(set(pictures.values())) == len(pictures)


def test_the_glossary_defines_no_word_twice():
    glossary = (CHECKOUT / "docs/reference/glossary.md").read_text(encoding="utf-8")
    words = [word for word in re.findall(r"^\| ([^|]+?) \|", glossary, re.MULTILINE) if word not in ("word", "---")]
    assert len(words) > 80
    assert sorted(word for word in words if words.count(word) > 1) == []


def test_no_test_patches_a_module_of_ours():
    """docs/explanation/architecture.md says so; what belongs to the system may be watched, as the writes of `os`."""
    patched = {
        (path.name, target)
        for path in tracked("tests/**/*.py")
        for target in re.findall(r"\b(?:monkeypatch\.setattr|mock\.patch\S*)\(\s*([^,)]+)", path.read_text())
    }
    assert {(name, target) for name, target in patched if target != "os" and name != Path(__file__).name} == set()
