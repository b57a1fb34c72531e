"""Takes pictures: each page once per screen, light and dark, as small as they go."""

from collections.abc import AsyncIterator, Collection, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from io import BytesIO
from itertools import product
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from playwright.async_api import Error as PlaywrightError

from tests.web.pictures.campus_day import CampusDay
from tests.web.pictures.doings import all_drawn
from tests.web.pictures.gallery import PICTURES, Picture, Scene
from tests.web.pictures.stage import Stage

Theme = Literal["light", "dark"]
Pixels = NDArray[np.uint8]
THEMES: Final[tuple[Theme, ...]] = ("light", "dark")
ALIKE: Final = 4
DRIVER: Final = "r5"


@dataclass(frozen=True)
class Shots:
    """On which screens, into which folder; `whole`: pages from top to bottom."""

    screens: Sequence[str]
    into: Path
    whole: bool = False


@dataclass(frozen=True)
class Taken:
    file: Path

    def __str__(self) -> str:
        return f"{self.file.name:36} {self.file.stat().st_size / 1000:5.1f} kB"


@dataclass(frozen=True)
class NotTaken:
    """The page did not come to show what it should."""

    picture: str
    why: str

    def __str__(self) -> str:
        return f"{self.picture}: NOT TAKEN. {self.why}"


async def take(stage: Stage, pictures: Sequence[Picture], shots: Shots) -> AsyncIterator[Taken | NotTaken]:
    """Each as it comes. Scenes follow each other: what goes wrong does so after all was well."""
    day = CampusDay(stage.service)
    await day.begins()
    with ExitStack() as beside:
        for scene in Scene:
            wanted = [picture for picture in pictures if picture.scene is scene]
            if wanted:
                await _goes_on(scene, day, stage, beside)
            for picture, on in product(wanted, shots.screens):
                try:
                    for file in await _take_one(stage, day, picture, on, shots):
                        yield Taken(file)
                except (PlaywrightError, AssertionError) as failure:
                    yield NotTaken(f"{picture.name}-{on}", str(failure).partition("\n")[0])


async def _goes_on(scene: Scene, day: CampusDay, stage: Stage, beside: ExitStack) -> None:
    if scene is Scene.TROUBLE:
        await day.trouble()
    if scene is Scene.MIND:
        beside.enter_context(stage.robot_drives(DRIVER, await day.new_robot(DRIVER)))
        sender = await stage.visitor("bob.martin", "desk")  # by the service itself, whose dispatch hears of it
        await sender.order("grace.hill@campus.example", "canal", "steacie", "Signed forms")


async def _take_one(stage: Stage, day: CampusDay, picture: Picture, on: str, shots: Shots) -> list[Path]:
    """Both themes of a page that is opened once."""
    visitor = await stage.visitor(picture.who, on)
    page = await visitor.context.new_page()
    await page.goto(picture.address.format(guest_link=day.links["guest"], **day.ids))
    await page.locator(picture.shows).first.wait_for()
    if picture.doing:
        await picture.doing(page)
    files = []
    for theme in THEMES:
        await page.emulate_media(color_scheme=theme, reduced_motion="reduce")
        await all_drawn(page)
        file = shots.into / f"{picture.name}-{on}-{theme}.webp"
        _write(await page.screenshot(full_page=shots.whole), file)
        files.append(file)
    await page.close()
    return files


def _write(png: bytes, file: Path) -> None:
    """Lossless WebP of a picture with few colours: every letter stays sharp, in two thirds of the bytes."""
    picture = np.asarray(Image.open(BytesIO(png)).convert("RGB"))
    Image.fromarray(_with_few_colours(picture)).save(file, "WEBP", lossless=True, method=6)


def _with_few_colours(picture: Pixels) -> Pixels:
    """Those that cover most stay as they are, and a small red stays red: left out is what looks like one of them."""
    found, where, counts = np.unique(picture.reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    colours = found.astype(np.int16)
    becomes = np.full(len(colours), -1)
    for most in np.argsort(-counts, kind="stable"):
        if becomes[most] < 0:
            alike = np.abs(colours - colours[most]).max(axis=1) <= ALIKE
            becomes[alike & (becomes < 0)] = most
    return found[becomes][where].reshape(picture.shape)


def chosen(names: Collection[str]) -> list[Picture]:
    """In the gallery's order; all of them if none is named."""
    return [picture for picture in PICTURES if not names or picture.name in names]
