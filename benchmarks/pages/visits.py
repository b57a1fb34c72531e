"""One visit of a page, as a slow phone makes it, seen from inside the browser."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any, Final

from playwright.async_api import Browser, BrowserContext, CDPSession, Page, async_playwright

from benchmarks.pages.chromium import find_chromium

PHONE: Final[dict[str, Any]] = {
    "viewport": {"width": 412, "height": 839},
    "device_scale_factor": 2.625,
    "is_mobile": True,
    "has_touch": True,
    "locale": "en-CA",
}
DOWN_BYTES_S: Final = 1.6e6 / 8
UP_BYTES_S: Final = 0.75e6 / 8
ROUND_TRIP_MS: Final = 150
CPU_TIMES_SLOWER: Final = 4
QUIET_S: Final = 1.5
"""The page has got what it asks for by itself."""
GIVE_UP_S: Final = 30

WATCH: Final = """selector => {
  window.layoutShift = 0;
  new PerformanceObserver((list) => {
    for (const shift of list.getEntries()) if (!shift.hadRecentInput) window.layoutShift += shift.value;
  }).observe({ type: "layout-shift", buffered: true });
  const look = () => {
    waiting = false;
    const element = document.querySelector(selector);
    const options = element?.matches("select") ? element.options.length > 1 : true;
    if (!element?.checkVisibility() || element.disabled || !options) return;
    changes.disconnect();
    tellUsable(String(performance.now()));
  };
  let waiting = false;
  const changes = new MutationObserver(() => {
    if (!waiting) requestAnimationFrame(look);
    waiting = true;
  });
  changes.observe(document, { subtree: true, childList: true, attributes: true });
}"""
"""Looks in the frame that follows a change, and only then: the slowed processor would have to draw all others."""


@dataclass(frozen=True)
class Visit:
    """The time until the page could be used, and until it was quiet."""

    usable_ms: float
    transferred_kb: float
    requests: int
    calls: int
    """Of the API, the event stream among them."""
    layout_shift: float


@asynccontextmanager
async def a_browser() -> AsyncIterator[Browser]:
    async with async_playwright() as playwright:
        yield await playwright.chromium.launch(
            executable_path=find_chromium(), args=["--disable-background-networking"]
        )


class _Traffic:
    """Counts what comes over the wire, heads included, and what the browser had already does not."""

    def __init__(self, cdp: CDPSession) -> None:
        self.heads: dict[str, float] = {}
        self.whole: dict[str, float] = {}
        self.asked = self.calls = 0
        cdp.on("Network.requestWillBeSent", self._ask)
        cdp.on("Network.responseReceived", self._head)
        cdp.on("Network.loadingFinished", self._end)

    def _ask(self, event: dict[str, Any]) -> None:
        url = event["request"]["url"]
        self.asked += not url.startswith("data:")
        self.calls += "/api/" in url

    def _head(self, event: dict[str, Any]) -> None:
        self.heads[event["requestId"]] = event["response"]["encodedDataLength"]

    def _end(self, event: dict[str, Any]) -> None:
        self.whole[event["requestId"]] = event["encodedDataLength"]

    @property
    def kb(self) -> float:
        return sum((self.heads | self.whole).values()) / 1000


async def visit(context: BrowserContext, address: str, selector: str) -> Visit:
    """Open `address` in a new page; it can be used when what `selector` names is visible and enabled."""
    page = await context.new_page()
    cdp = await _slowed(page)
    traffic = _Traffic(cdp)
    await page.add_init_script(f"({WATCH})({selector!r})")
    usable = await _told(cdp, "tellUsable")
    await page.goto(address, wait_until="commit")
    async with asyncio.timeout(GIVE_UP_S):
        usable_ms = float(await usable)
    before = -1
    while before != traffic.asked:
        before = traffic.asked
        await asyncio.sleep(QUIET_S)
    shift = float(await page.evaluate("window.layoutShift"))
    await page.close()
    return Visit(usable_ms, round(traffic.kb, 1), traffic.asked, traffic.calls, round(shift, 4))


async def _slowed(page: Page) -> CDPSession:
    cdp = await page.context.new_cdp_session(page)
    await cdp.send("Network.enable")
    conditions = {
        "offline": False,
        "latency": ROUND_TRIP_MS,
        "downloadThroughput": DOWN_BYTES_S,
        "uploadThroughput": UP_BYTES_S,
    }
    await cdp.send("Network.emulateNetworkConditions", conditions)
    await cdp.send("Emulation.setCPUThrottlingRate", {"rate": CPU_TIMES_SLOWER})
    return cdp


async def _told(cdp: CDPSession, name: str) -> asyncio.Future[str]:
    """Return what the page will say through a function of this name. The page is asked nothing meanwhile: Playwright's
    own waiting would have the slowed processor read 300 kB of script first."""
    said: asyncio.Future[str] = asyncio.get_running_loop().create_future()
    cdp.on("Runtime.bindingCalled", lambda event: said.done() or said.set_result(event["payload"]))
    await cdp.send("Runtime.enable")
    await cdp.send("Runtime.addBinding", {"name": name})
    return said


async def until_kept(context: BrowserContext) -> None:
    """The service worker, which comes after the page, has put away what it keeps."""
    page = await context.new_page()
    await page.goto("/manifest.webmanifest")
    await page.evaluate("() => navigator.serviceWorker.ready")
    await page.close()
