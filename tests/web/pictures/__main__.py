"""Pictures of all pages, phone and desk, light and dark: `make screenshots`."""

import asyncio
import os
import tempfile
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Final

import typer
from playwright.async_api import async_playwright

from benchmarks.pages.chromium import find_chromium
from tests.web.pictures.gallery import PICTURES, Picture
from tests.web.pictures.letters import environment
from tests.web.pictures.stage import SCREENS, set_up
from tests.web.pictures.taking import NotTaken, Shots, chosen, take
from tests.web.service import ROOT

QUIET: Final = ["--disable-gpu", "--disable-background-networking"]
GALLERY: Final = ROOT / "docs/pictures/pages"
PageName = StrEnum("PageName", {one.name.replace("-", "_").upper(): one.name for one in PICTURES})
Screen = StrEnum("Screen", {name.upper(): name for name in SCREENS})

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def main(
    *,
    only: Annotated[
        list[PageName] | None, typer.Option(help="This page; may be repeated. All if none is named.")
    ] = None,
    on: Annotated[list[Screen] | None, typer.Option(help="This screen alone.")] = None,
    into: Annotated[Path, typer.Option(help="Folder for the pictures.")] = GALLERY,
    locale: Annotated[str, typer.Option(help="Language of the browser.")] = "en-CA",
    width: Annotated[int, typer.Option(help="Another width of the screen, in CSS pixels; 0: as it is.")] = 0,
    whole: Annotated[
        bool, typer.Option("--whole", help="The pages from top to bottom, not what a screen shows.")
    ] = False,
) -> None:
    """Take pictures of the pages: the real service, with a day on the campus written into it, its robots simulated."""
    into.mkdir(parents=True, exist_ok=True)
    context: dict[str, Any] = {"locale": locale, **({"viewport": {"width": width, "height": 720}} if width else {})}
    shots = Shots([str(name) for name in on or Screen], into, whole)
    failed = asyncio.run(_take(chosen([str(name) for name in only or []]), shots, context))
    raise typer.Exit(bool(failed))


async def _take(pictures: list[Picture], shots: Shots, context: dict[str, Any]) -> int:
    """Take the pictures and return the number of pages that failed."""
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        async with async_playwright() as playwright:
            letters = {**os.environ, **environment(Path(folder))}
            browser = await playwright.chromium.launch(executable_path=find_chromium(), args=QUIET, env=letters)
            async with set_up(Path(folder), browser, playwright, **context) as stage:
                async for done in take(stage, pictures, shots):
                    failed += isinstance(done, NotTaken)
                    print(f"  {done}", flush=True)
            await browser.close()
    return failed


if __name__ == "__main__":
    app()
