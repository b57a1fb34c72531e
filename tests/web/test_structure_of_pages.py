"""What the pages are made of: what a strict policy allows, and nothing that waits in line to be fetched."""

import re
from pathlib import Path

import pytest

from web import make_pages

WEB = Path(__file__).parents[2] / "web"
PAGES = sorted(WEB.glob("*.html"))
SCRIPTS = [path for path in sorted(WEB.rglob("*.js")) if "node_modules" not in path.parts]
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


def test_what_is_made_of_other_files_is_up_to_date():
    """The pages' lists of modules, so that none waits for another, and the types of what the service sends."""
    made = make_pages.made_files()
    assert [file.name for file, text in made.items() if file.read_text(encoding="utf-8") != text] == []
    assert len(made) == len(PAGES) + 2


def test_only_one_file_knows_addresses_of_the_service():
    assert [path.name for path in SCRIPTS if "/api/v1" in path.read_text(encoding="utf-8")] == ["api.js"]


@pytest.mark.parametrize("folder", [WEB, WEB.parent / ".ci/lint"], ids=["pages", "lint"])
def test_a_lock_file_names_no_host(folder):
    assert "://" not in (folder / "package-lock.json").read_text(encoding="utf-8")
