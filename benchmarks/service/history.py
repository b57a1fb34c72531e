"""A page of "my mail" with a long history behind it, beside the same page with a short one, in turns."""

import asyncio
import time
from pathlib import Path
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.service.figures import middle, times
from benchmarks.service.filling import Account, Filling, fill
from benchmarks.service.samples import Samples
from benchmarks.service.servers import Server, service
from benchmarks.service.web_client import Visitor

SHORT: Final = 200
PAGE: Final = 20
REQUESTS_AT_A_TIME: Final = 20
PAGES: Final = {
    "first": f"/api/v1/orders?limit={PAGE}",
    "sent": f"/api/v1/orders?limit={PAGE}&role=sent",
    "coming": f"/api/v1/orders?limit={PAGE}&role=coming",
}

WANTED = tuple(
    Wanted(f"{whose}.{page}.slower_by", at_most=0.2)
    for whose in ("all_mine", "of_a_campus")
    for page in (*PAGES, "third")
)
"""By which share the page is slower: with 100,000 orders of one's own, and with as many of everybody."""


def measure(samples: Samples) -> dict[str, Any]:
    with samples.folder() as folder:
        short = _filled(folder / "short", SHORT, 2)
        all_mine = _filled(folder / "all_mine", samples.history, 2)
        # Everybody has three pages at least.
        of_a_campus = _filled(folder / "of_a_campus", samples.history, max(2, min(500, samples.history // 100)))
        say(f"  {samples.history} orders are written, twice")
        with (
            service(folder / "short") as reference,
            service(folder / "all_mine") as mine,
            service(folder / "of_a_campus") as campus,
        ):
            asked = {"short": (reference, short), "all_mine": (mine, all_mine), "of_a_campus": (campus, of_a_campus)}
            return asyncio.run(_measure(samples, asked))


def _filled(folder: Path, orders: int, people: int) -> Account:
    async def history(filling: Filling) -> list[Account]:
        accounts = await filling.people(people)
        await filling.history(accounts, orders)
        return accounts

    account: Account = fill(folder, history)[0]
    return account


async def _measure(samples: Samples, asked: dict[str, tuple[Server, Account]]) -> dict[str, Any]:
    visitors = {name: Visitor(server.port, account.cookie) for name, (server, account) in asked.items()}
    pages = {name: {**PAGES, "third": await _third_page(visitor)} for name, visitor in visitors.items()}
    took_s: dict[str, dict[str, list[float]]] = {name: {page: [] for page in pages[name]} for name in visitors}
    for number in range(max(2, round(samples.seconds))):
        for name, visitor in visitors.items():
            visitor.close()  # the service keeps no idle connection for long
            for page, path in pages[name].items():
                await _ask(visitor, path)
                asking = [await _ask(visitor, path) for _ in range(REQUESTS_AT_A_TIME)]
                took_s[name][page] += asking if number else []  # the first time is for warming up
    for visitor in visitors.values():
        visitor.close()
    return {
        "short": {page: times(one) for page, one in took_s["short"].items()},
        **{name: _beside(took_s[name], took_s["short"]) for name in visitors if name != "short"},
        "memory": {name: server.memory_mib() for name, (server, _) in asked.items()},
    }


async def _third_page(visitor: Visitor) -> str:
    path = PAGES["first"]
    for _ in range(2):
        answer = await visitor.get(path)
        assert answer.status == 200, answer
        page = answer.json()
        path = f"{PAGES['first']}&cursor={page['next']}"
    return path


async def _ask(visitor: Visitor, path: str) -> float:
    begun_s = time.perf_counter()
    answer = await visitor.get(path)
    took_s = time.perf_counter() - begun_s
    assert answer.status == 200, answer
    assert 0 < len(answer.json()["items"]) <= PAGE
    return took_s


def _beside(long_s: dict[str, list[float]], short_s: dict[str, list[float]]) -> dict[str, Any]:
    return {
        page: {**times(one), "slower_by": round(middle(one) / middle(short_s[page]) - 1, 3)}
        for page, one in long_s.items()
    }
