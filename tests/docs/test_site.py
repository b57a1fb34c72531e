"""The documentation site: it builds without a warning, lists what the code has, and its search works offline."""

import asyncio
import sys
from asyncio.subprocess import PIPE, STDOUT
from pathlib import Path

import pytest
from playwright.async_api import async_playwright, expect

from benchmarks.pages.chromium import find_chromium
from docs.site import reference, staging
from docs.site.staging import CHECKOUT

PLACES = {
    CHECKOUT / "docs/how-to/drive.md": Path("how-to/drive.md"),
    CHECKOUT / "docs/explanation/why.md": Path("explanation/why.md"),
    CHECKOUT / "README.md": Path("index.md"),
}


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("[why](../explanation/why.md#so)", "[why](../explanation/why.md#so)"),
        ("[start](../../README.md)", "[start](../index.md)"),
        ("[the settings](../../robot/core/config.py)", "the settings (`robot/core/config.py`)"),
        ("[config.py](../../robot/core/config.py)", "config.py"),
        ("[paper](https://example.org/p)", "[paper](https://example.org/p)"),
        ("[gone](../explanation/gone.md)", "[gone](../explanation/gone.md)"),
        ("```\n[kept](../../robot/core/config.py)\n```", "```\n[kept](../../robot/core/config.py)\n```"),
    ],
)
def test_links_hold_in_the_site_and_links_to_code_become_words(before, after):
    assert staging.with_links(before, CHECKOUT / "docs/how-to/drive.md", PLACES) == after


@pytest.mark.nightly
def test_the_reference_lists_everything_that_the_code_has():
    pages = reference.pages()
    assert "| `CAMPUS_MAIL_PORT` | `8000` |" in pages["settings.md"]
    assert "| `line.lead_mm` |" in pages["settings.md"]
    assert pages["messages.md"].count("\n### ") > 20
    names = [*reference.STANDARD.actions, *reference.STANDARD.functions]
    assert pages["internal-actions.md"].count("\n| `") == len(names)
    assert "\n### POST /api/v1/orders\n" in pages["api-operations.md"]
    assert "\n| `unknown_post` | 422 |" in pages["api-operations.md"]
    assert "\n### NewOrder\n" in pages["api-operations.md"]
    assert all(f"\n## `python -m {package}`\n" in pages["commands.md"] for package in reference.COMMANDS)


@pytest.mark.browser
@pytest.mark.timeout(300)
@pytest.mark.nightly
async def test_the_site_builds_without_a_warning_and_its_search_works_from_files():
    pytest.importorskip("zensical", reason="make setup-develop installs it")
    built = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "docs.site", cwd=CHECKOUT, stdout=PIPE, stderr=STDOUT
    )
    said, _ = await built.communicate()
    assert built.returncode == 0, said.decode()
    badly_fenced = [page.name for page in staging.SITE.rglob("*.html") if "\n```" in page.read_text(encoding="utf-8")]
    assert badly_fenced == []
    foreign: list[str] = []
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(executable_path=find_chromium(), args=["--no-sandbox"])
        page = await browser.new_page()
        page.on("request", lambda request: None if request.url.startswith("file:") else foreign.append(request.url))
        for shown in ("reference/commands.html", "decisions/README.html", "tutorials/own-campus.html", "index.html"):
            place = staging.SITE / shown
            place = place if place.exists() else place.with_name("index.html")
            await page.goto(place.as_uri())
            await expect(page.get_by_role("heading", level=1)).to_be_visible()
        await page.get_by_role("button", name="Search").first.click()
        await page.get_by_role("combobox", name="Search").press_sequentially("annex")
        await expect(page.get_by_text("Your own campus in 15 minutes").last).to_be_visible(timeout=30_000)
        await browser.close()
    assert foreign == []
