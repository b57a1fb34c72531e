"""Use by keyboard alone: Tab reaches everything, and the focus is visible at each stop."""

import re
from typing import Any, Final

from playwright.async_api import Page

from tests.web.service import ROOT

EYES: Final = (ROOT / "tests/web/keys.js").read_text(encoding="utf-8")
IS_ASKED_FOR: Final = "() => performance.getEntriesByType('resource').some(({name}) => /keeps_keyboard/.test(name))"
MAP_COMES: Final = (
    "() => [...document.querySelectorAll('campus-map')].find((one) => one.checkVisibility())?.scrollIntoView()"
)
MAP_IS_THERE: Final = """() => [...document.querySelectorAll("campus-map")]
  .every((one) => !one.checkVisibility() || one.querySelector("svg"))"""
A_FRAME: Final = "() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))"
MOST_STOPS: Final = 250


async def press(page: Page, button: str) -> None:
    """A button whose name begins so, with the keyboard."""
    found = page.get_by_role("button", name=re.compile(f"^{button}"))
    await found.focus()
    await page.keyboard.press("Enter")


class Keyboard:
    """Presses keys and never points; an invisible stop, or one outside the page, fails the test at once."""

    def __init__(self, page: Page) -> None:
        self.page = page

    async def press(self, *keys: str) -> None:
        for key in keys:
            await self.page.keyboard.press(key)

    async def type(self, text: str) -> None:
        await self.page.keyboard.type(text)

    async def stands(self) -> None:
        """The focus keeper is fetched at the first key; a map when it comes into view."""
        await self.page.evaluate(MAP_COMES)
        await self.page.wait_for_function(MAP_IS_THERE)
        await self.page.evaluate("() => scrollTo(0, 0)")
        while not await self.page.evaluate(IS_ASKED_FOR):
            await self.press("Shift")
        await self.page.evaluate("() => import('/src/elements/keeps_keyboard.js')")

    async def to(self, name: str, key: str = "Tab") -> None:
        """On to the next stop whose name begins like this."""
        passed: list[str] = []
        for _ in range(MOST_STOPS):
            await self.press(key)
            here = await self.here()
            if re.match(name, here):
                return
            passed.append(here)
        raise AssertionError(f"the keyboard does not come to {name}, only to {passed}")

    async def here(self) -> str:
        """The name of what has the keyboard; empty where nothing has it."""
        here: dict[str, Any] = await self._ask("here")
        if here["wrong"]:  # a notification makes way with the next frame, which a busy machine draws late
            await self.page.evaluate(A_FRAME)
            here = await self._ask("here")
        assert not here["wrong"], here["wrong"]
        return str(here["name"])

    async def walk(self) -> list[str]:
        """From the beginning of the page, or of an open dialog, to its end: every stop on the way.

        What has appeared behind the keyboard meanwhile, such as a new alarm, is come to on a second way.
        """
        there = set(await self._ask("all"))
        stops = await self._round()
        missed = await self._ask("missed")
        if missed and not there.intersection(missed):
            await self._round()
            missed = await self._ask("missed")
        assert not missed, f"the keyboard never comes to {missed}, only to {stops}"
        return stops

    async def _round(self) -> list[str]:
        stops, _ = list[str](), await self.here()
        while len(stops) < MOST_STOPS:
            await self.press("Tab")
            here = await self.here()
            if not here or (stops and here == stops[0] and not await self._ask("missed")):
                break
            stops.append(here)
        return stops

    async def _ask(self, what: str) -> Any:
        return await self.page.evaluate(f"() => (window.keys || ({EYES}, window.keys)).{what}()")
