"""Structure of the pages: a strict policy, no module that waits in line, no circles of imports."""

import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from app.http.page_files import LEFT_OUT
from web import make_pages

WEB = Path(__file__).parents[2] / "web"
PAGES = sorted(WEB.glob("public/*.html"))
TEXTS_OF = re.compile(r"const TEXTS_OF = \{(.*?)\}")
LATER = re.compile(r"\bimport\(\"([^\"]+)\"\)")
TEXT = re.compile(r"\b(?:t|counted|hasText)\((?:[^()\"`]*\? ?)?[\"`](\w+)\.")
SCRIPTS = sorted([*WEB.glob("src/*/*.js"), *WEB.glob("public/*.js")])
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
    """The pages with their lists of modules, so that none waits in line, and the types of what the service sends."""
    made = make_pages.made_files()
    assert [file.name for file, text in made.items() if file.read_text(encoding="utf-8") != text] == []
    assert len(made) == len(PAGES) + 2


def test_only_one_file_knows_addresses_of_the_service():
    assert [path.name for path in SCRIPTS if "/api/v1" in path.read_text(encoding="utf-8")] == ["api.js"]


def test_the_lock_file_names_no_host():
    assert "://" not in (WEB / "package-lock.json").read_text(encoding="utf-8")


def test_no_modules_import_each_other_in_a_circle():
    """Neither at once nor later: a circle is one module that only looks like several."""
    ours = {f"/{path.relative_to(WEB)}" for path in SCRIPTS if "src" in path.parts}
    imports = {module: imported_by(module) & ours for module in ours}
    TopologicalSorter(imports).prepare()  # raises CycleError, which names the circle


def imported_by(module: str) -> set[str]:
    text = make_pages.code_of(module)
    return {make_pages.resolve(module, name) for name in [*LATER.findall(text), *make_pages.IMPORT.findall(text)]}


def pages_sent(kind: str) -> list[Path]:
    """The pages that fetch the texts of this kind."""
    listed = TEXTS_OF.search((WEB / "src/texts/texts.js").read_text(encoding="utf-8"))
    assert listed
    named = dict(re.findall(r'"/([\w-]+\.html)": "\.?(\w*)"', listed[1]))
    assert named.keys() <= {page.name for page in PAGES}
    return [page for page in PAGES if named.get(page.name, "everyday") == kind]


def modules_of(pages: list[Path]) -> set[str]:
    """Every module of ours that these pages may fetch, at once or later."""
    html = "".join(page.read_text(encoding="utf-8") for page in pages)
    waiting, found = [one for one in re.findall(r"/[\w/.@-]+\.js", html) if not one.startswith("/npm/")], set()
    while waiting:
        module = waiting.pop()
        if module in found or module == "/src/offline/page_files.js" or module.startswith("/npm/"):
            continue
        found.add(module)
        waiting += imported_by(module)
    return found


@pytest.mark.parametrize(
    ("kind", "among_others"),
    [
        (
            "everyday",
            {"/src/pages/order.js", "/src/follow/follow_page.js", "/src/map/campus_map.js", "/src/offline/push.js"},
        ),
        ("mailroom", {"/src/pages/mailroom.js", "/src/mailroom/mailroom_wall.js", "/src/mailroom/unsent_mail.js"}),
    ],
)
def test_pages_need_no_text_that_they_are_not_sent(kind, among_others):
    modules = modules_of(pages_sent(kind))
    assert among_others <= modules
    texts = {module: make_pages.file_of(module).read_text(encoding="utf-8") for module in modules}
    missed = {
        (module, family) for module, text in texts.items() for family in TEXT.findall(text) if family in LEFT_OUT[kind]
    }
    assert not missed
