"""What the pages are made of: what a strict policy allows, and nothing that waits in line to be fetched."""

import json
import posixpath
import re
from pathlib import Path

import pytest

WEB = Path(__file__).parents[2] / "web"
PAGES = sorted(WEB.glob("*.html"))
SCRIPTS = [path for path in sorted(WEB.rglob("*.js")) if "node_modules" not in path.parts]
IMPORT = re.compile(r"""(?:^|[;\s}])(?:import|export)\s*(?:[\w$*{][^"';]*?from)?\s*["']([^"']+)["']""", re.MULTILINE)
IMPORT_MAP = re.compile(r"<script type=\"importmap\">(.*?)</script>", re.DOTALL)


@pytest.fixture(params=PAGES, ids=lambda page: page.name)
def html(request: pytest.FixtureRequest) -> str:
    return str(request.param.read_text(encoding="utf-8"))


def test_a_page_has_no_script_or_style_of_its_own_but_the_import_map(html):
    scripts = re.findall(r"<script([^>]*)>(.*?)</script>", html, re.DOTALL)
    assert [attributes for attributes, text in scripts if text] == [' type="importmap"']
    assert not re.search(r"\son\w+=|\sstyle=|<style|javascript:", html)


def test_all_pages_have_the_same_import_map():
    assert len({IMPORT_MAP.search(page.read_text(encoding="utf-8"))[1] for page in PAGES}) == 1


def test_a_page_names_all_modules_that_it_needs_so_that_none_waits_for_another(html):
    named = set(re.findall(r'<link rel="modulepreload" href="([^"]+)"', html))
    (first,) = re.findall(r'<script type="module" src="([^"]+)"', html)
    assert named == modules_behind(first, json.loads(IMPORT_MAP.search(html)[1])["imports"])


def modules_behind(first: str, import_map: dict[str, str]) -> set[str]:
    """Every module that a module imports, at any depth; without itself."""
    found, waiting = set(), [first]
    while waiting:
        module = waiting.pop()
        text = re.sub(r"/\*.*?\*/", "", file_of(module).read_text(encoding="utf-8"), flags=re.DOTALL)
        waiting += {resolve(module, name, import_map) for name in IMPORT.findall(text)} - found
        found |= set(waiting)
    return found - {first}


def resolve(module: str, name: str, import_map: dict[str, str]) -> str:
    if name.startswith("."):
        return posixpath.normpath(posixpath.join(posixpath.dirname(module), name))
    if name in import_map:
        return import_map[name]
    prefix = max((key for key in import_map if key.endswith("/") and name.startswith(key)), key=len)
    return import_map[prefix] + name.removeprefix(prefix)


def file_of(module: str) -> Path:
    return WEB / module.replace("/npm/", "node_modules/", 1).removeprefix("/")


def test_only_one_file_knows_addresses_of_the_service():
    assert [path.name for path in SCRIPTS if "/api/v1" in path.read_text(encoding="utf-8")] == ["api.js"]


@pytest.mark.parametrize("folder", [WEB, WEB.parent / ".ci/lint"], ids=["pages", "lint"])
def test_a_lock_file_names_no_host(folder):
    assert "://" not in (folder / "package-lock.json").read_text(encoding="utf-8")
