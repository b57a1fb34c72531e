"""Looks at a page as it stands: in both themes, on a desk and on a phone, with larger text and in a small window."""

import json
import re
from typing import Any, Final, Literal

from playwright.async_api import CDPSession

from tests.web.mailroom_scene import ORDERS
from tests.web.service import ROOT
from tests.web.visitor import AXE, Visitor

MEASURES: Final = (ROOT / "tests/web/looking.js").read_text(encoding="utf-8")
TEXTS: Final = {
    name: json.loads((ROOT / f"web/src/texts/{name}.json").read_text(encoding="utf-8")) for name in ("en", "fr")
}
FAMILIES: Final = "|".join(sorted({key.partition(".")[0] for key in TEXTS["en"]}))
GAP: Final = re.compile(rf"\{{\w+\}}|^({FAMILIES})(\.[a-z_0-9]+)+$|\bundefined\b|\bNaN\b|\[object ")

SAID_BY_PEOPLE: Final = {facts[-1] for facts in ORDERS}
Theme = Literal["light", "dark"]
DESK: Final = {"width": 1280, "height": 860}
PHONE: Final = {"width": 412, "height": 839}
NARROW: Final = {"width": 320, "height": 640}
ZOOMED_DESK: Final = {"width": 640, "height": 430}
"""A desk's window at 200 %: half as many pixels of the page."""
FINGER_PX: Final = 44
POINTER_PX: Final = 24
USUAL_TEXT_PX: Final = 16

CONTRAST: Final = ["color-contrast", "link-in-text-block"]
AXE_RUN: Final = """async (rules) => {
  const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];
  const runOnly = rules ? { type: "rule", values: rules } : { type: "tag", values: tags };
  const { violations } = await axe.run(document, { runOnly, resultTypes: ["violations"] });
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" ")}`);
}"""


class Looker:
    """A visitor that measures pages; faults are collected, so that one visit reports them all."""

    def __init__(self, person: Visitor) -> None:
        self.person, self.page = person, person.page
        self.wrong: list[str] = []
        self.seen: list[str] = []

    async def look(self, state: str) -> None:
        """Take all measures on one state of a page; it is left as it was found: on a desk, light."""
        await self._take_measures()
        self.seen.append(state)
        await self._axe(state, "desk, light")
        await self._layout(state, "desk", POINTER_PX)
        await self._in(DESK, "dark")
        await self._axe(state, "desk, dark", CONTRAST)
        await self._in(NARROW, "dark")
        await self._axe(state, "320 px, dark")
        await self._layout(state, "320 px", FINGER_PX)
        await self._in(NARROW, "light")
        await self._axe(state, "320 px, light", CONTRAST)
        await self._in(ZOOMED_DESK, "light")
        await self._layout(state, "zoom 200 %", POINTER_PX)
        await self._with_large_text(state)
        await self._in(DESK, "light")

    async def look_at_words(self, state: str) -> None:
        """In another language: what is said, whether it fits, and both themes."""
        await self._take_measures()
        self.seen.append(state)
        self._note(state, "words", self.untranslated(await self.page.evaluate("() => looking.said()")))
        for size, place in ((DESK, "desk"), (PHONE, "phone"), (NARROW, "320 px")):
            await self._in(size, "light")
            await self._layout(state, place, POINTER_PX)
        await self._axe(state, "320 px, light")
        await self._in(NARROW, "dark")
        await self._axe(state, "320 px, dark", CONTRAST)
        await self._in(DESK, "light")

    def untranslated(self, said: list[str]) -> list[str]:
        """Keys and gaps; and, where the page speaks French, sentences that only the English catalogue has."""
        language = str(self.person.options["locale"])[:2]
        others = {text for name, catalogue in TEXTS.items() if name != language for text in catalogue.values()}
        foreign = others - set(TEXTS[language].values()) - SAID_BY_PEOPLE
        return [text for text in said if GAP.search(text) or text in foreign]

    async def moving(self, state: str) -> None:
        """Note motion although the person prefers less."""
        await self._take_measures()
        self._note(state, "motion", await self.page.evaluate("() => looking.moving()"))

    async def _take_measures(self) -> None:
        if not await self.page.evaluate("() => Boolean(window.looking)"):
            await self.page.evaluate(f"{MEASURES};{AXE.read_text(encoding='utf-8')}")

    async def _in(self, size: Any, theme: Theme) -> None:
        await self.page.emulate_media(color_scheme=theme, reduced_motion="reduce")
        if self.page.viewport_size != size:
            await self.page.set_viewport_size(size)
        await self.page.evaluate("() => looking.settled()")

    async def _axe(self, state: str, place: str, rules: list[str] | None = None) -> None:
        self._note(state, place, await self.page.evaluate(AXE_RUN, rules))
        self._note(state, place, await self.page.evaluate("() => looking.faint()"))

    async def _layout(self, state: str, place: str, target_px: int) -> None:
        self._note(state, place, await self.page.evaluate("() => looking.layout()"))
        self._note(state, place, await self.page.evaluate("(least) => looking.small(least)", target_px))

    async def _with_large_text(self, state: str) -> None:
        """As when a browser is told to use letters twice as large."""
        browser = await self.page.context.new_cdp_session(self.page)
        await _letters_of(browser, 2 * USUAL_TEXT_PX)
        for size, place in ((DESK, "text 200 %, desk"), (PHONE, "text 200 %, phone")):
            await self._in(size, "light")
            await self._layout(state, place, POINTER_PX)
        await _letters_of(browser, USUAL_TEXT_PX)
        await browser.detach()

    def _note(self, state: str, place: str, wrong: list[str]) -> None:
        self.wrong += [f"{state} ({place}): {one}" for one in wrong]


async def _letters_of(browser: CDPSession, size_px: int) -> None:
    await browser.send("Page.setFontSizes", {"fontSizes": {"standard": size_px, "fixed": size_px * 13 // 16}})
