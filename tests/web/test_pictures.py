"""The pictures of the pages: they can be taken, and those that the docs show are there, small, and none of them old."""

import re
from pathlib import Path
from typing import Final

import pytest
from PIL import Image
from playwright.async_api import Browser, Playwright

from tests.web.pictures.gallery import PICTURES
from tests.web.pictures.stage import SCREENS, set_up
from tests.web.pictures.taking import THEMES, Shots, Taken, chosen, take
from tests.web.service import ROOT

GALLERY: Final = ROOT / "docs/pictures/pages"
SHOWN: Final = re.compile(r"pictures/pages/([\w-]+\.webp)")
LARGEST_BYTES, ALL_BYTES = 100_000, 2_500_000


@pytest.mark.browser
@pytest.mark.nightly
async def test_a_picture_of_a_page_is_taken_in_both_themes(
    chromium: Browser, playwright_here: Playwright, tmp_path: Path
):
    data = tmp_path / "data"
    data.mkdir()
    async with set_up(data, chromium, playwright_here) as stage:
        taken = [one async for one in take(stage, chosen(["hand-over"]), Shots(["phone"], tmp_path))]
    assert all(isinstance(one, Taken) for one in taken), taken
    light, dark = (Image.open(one.file).convert("L") for one in taken)
    assert light.width == 412 * 1.5
    assert light.getpixel((5, 5)) > 200
    assert dark.getpixel((5, 5)) < 60
    across = [dark.getpixel((x, dark.height * 3 // 4)) for x in range(dark.width)]
    assert (min(across) < 10, max(across) > 250) == (True, True), "the code is seen, black on white in either theme"


def test_the_gallery_has_every_picture_and_no_other_and_stays_small():
    files = {file.name: file.stat().st_size for file in GALLERY.iterdir()}
    names = [f"{picture.name}-{on}-{theme}.webp" for picture in PICTURES for on in SCREENS for theme in THEMES]
    assert set(files) == set(names), "`make screenshots` takes them"
    assert max(files.values()) < LARGEST_BYTES
    assert sum(files.values()) < ALL_BYTES
    pages = ("docs/reference/pages.md", "README.md")
    shown = {name for page in pages for name in SHOWN.findall((ROOT / page).read_text())}
    assert shown <= set(files)
    assert {name.rsplit("-", 2)[0] for name in shown} == {picture.name for picture in PICTURES}
