"""Measure the pages as a slow phone opens them: what is transferred, when they can be used, what moves."""

import asyncio
import json
import os
import platform
import tempfile
from collections.abc import Sequence, Set
from enum import StrEnum
from pathlib import Path
from statistics import median
from typing import Annotated, Any, Final

import typer
from playwright.async_api import Browser

from benchmarks.body.report import Wanted, missed, say, table
from benchmarks.pages import visits
from benchmarks.pages.scene import Scene, make_scene, order_all
from benchmarks.pages.visits import PHONE, Visit, a_browser, visit
from benchmarks.service.filling import Account
from benchmarks.service.servers import Server, service

FORM: Final = "[name=from_post]"
FIRST: Final = (
    Wanted("transferred_kb", at_most=100, unit="kB"),
    Wanted("usable_ms", at_most=1500, unit="ms"),
    Wanted("layout_shift", at_most=0.05),
)


class Page(StrEnum):
    """A page to visit. A first visit has an empty browser; a second one is answered by the service worker."""

    ORDER = "order"
    ORDER_AGAIN = "order_again"
    FOLLOW = "follow"
    MAILROOM = "mailroom"


PARTS: Final[dict[Page, tuple[Wanted, ...]]] = {
    Page.ORDER: (*FIRST, Wanted("calls", at_most=5)),
    Page.ORDER_AGAIN: (Wanted("usable_ms", at_most=1000, unit="ms"), Wanted("layout_shift", at_most=0.05)),
    Page.FOLLOW: FIRST[1:],
    Page.MAILROOM: (Wanted("transferred_kb", at_most=120, unit="kB"), Wanted("calls", at_most=12), FIRST[2]),
}

SHOWN: Final = {
    Page.FOLLOW: ("/follow.html?order={order}", ".standing h1"),
    Page.MAILROOM: ("/mailroom.html", ".queue .act"),
}
"""The address, and what can be used once it is there; the others show the form."""

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    pages: Annotated[list[Page] | None, typer.Argument(help="Which; all of them if none is named.")] = None,
    *,
    runs: Annotated[int, typer.Option(min=1, help="Visits of each page; the median counts.")] = 5,
    as_json: Annotated[bool, typer.Option("--json", help="JSON alone, without the table.")] = False,
) -> None:
    """Print what was measured, as JSON, beside what is wanted. Ends with 1 if anything wanted was missed.

    A page can be used when the field "from" (followed: the sentence that says where the letter is; the mailroom: the
    queue) is visible and enabled. The browser's own throttling makes the phone: the person is signed in, the cache is
    empty. Calls are requests to the API, the event stream among them.
    """
    wanted = {page: PARTS[page] for page in pages or PARTS}
    seen = _visits(runs, set(wanted))
    reports = {page: _report(seen[page], bounds) for page, bounds in wanted.items()}
    if not as_json:
        say("\n" + table(reports))
    print(json.dumps({"machine": _machine(), "runs": runs, "parts": reports}, indent=2))
    raise typer.Exit(bool(missed(reports)))


def _report(seen: Sequence[Visit], wanted: Sequence[Wanted]) -> dict[str, Any]:
    names = ("usable_ms", "transferred_kb", "requests", "calls", "layout_shift")
    figures: dict[str, Any] = {name: round(median(getattr(one, name) for one in seen), 3) for name in names}
    figures["each_usable_ms"] = [round(one.usable_ms) for one in seen]
    return {"figures": figures, "wanted": [one.judged(figures) for one in wanted]}


def _machine() -> dict[str, Any]:
    phone = {"cpu_times_slower": visits.CPU_TIMES_SLOWER, "round_trip_ms": visits.ROUND_TRIP_MS}
    phone |= {"down_bytes_s": round(visits.DOWN_BYTES_S)}
    return {"python": platform.python_version(), "system": platform.platform(), "cores": os.cpu_count(), **phone}


def _visits(runs: int, wanted: Set[Page]) -> dict[Page, list[Visit]]:
    with tempfile.TemporaryDirectory() as folder:
        scene = make_scene(Path(folder))
        with service(Path(folder)) as server:
            return asyncio.run(_visit_all(server, scene, runs, wanted))


async def _visit_all(server: Server, scene: Scene, runs: int, wanted: Set[Page]) -> dict[Page, list[Visit]]:
    seen: dict[Page, list[Visit]] = {page: [] for page in wanted}
    followed = await order_all(server, scene)
    async with a_browser() as browser:
        for run in range(runs):
            say(f"  visit {run + 1} of {runs}")
            for pages in _in_one_browser(wanted):
                account = scene.dispatcher if Page.MAILROOM in pages else scene.sender
                for page, found in (await _visit_once(browser, server, account, followed, pages)).items():
                    seen.get(page, []).append(found)
    return seen


async def _visit_once(
    browser: Browser, server: Server, account: Account, followed: str, pages: Sequence[Page]
) -> dict[Page, Visit]:
    """One after the other in a browser of its own."""
    origin = f"http://127.0.0.1:{server.port}"
    cookie: Any = {"name": "session", "value": account.cookie, "url": origin}
    seen: dict[Page, Visit] = {}
    context = await browser.new_context(base_url=origin, **PHONE)
    await context.add_cookies([cookie])
    for page in pages:
        address, selector = SHOWN.get(page, ("/", FORM))
        seen[page] = await visit(context, address.format(order=followed), selector)
        if page != pages[-1]:
            await visits.until_kept(context)
    await context.close()
    return seen


def _in_one_browser(wanted: Set[Page]) -> list[list[Page]]:
    """The second visit of a page has a first one before it."""
    orders = [Page.ORDER, Page.ORDER_AGAIN] if Page.ORDER_AGAIN in wanted else [Page.ORDER]
    others = [page for page in SHOWN if page in wanted]
    return [*([orders] if wanted - {*others} else []), *([page] for page in others)]


if __name__ == "__main__":
    app()
