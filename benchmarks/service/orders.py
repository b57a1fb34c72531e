"""Order creation, beside a bare endpoint with one durable insert: in turns, in the same run, by the same client."""

import asyncio
import sqlite3
import time
from pathlib import Path
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.service.figures import middle, times
from benchmarks.service.filling import Account, Filling, fill
from benchmarks.service.samples import Samples, until
from benchmarks.service.servers import Server, bare, service
from benchmarks.service.web_client import Visitor

AT_ONCE: Final = 16
"""People who order at the same time, each waiting for their answer before they order again."""
SETTLES_WITHIN_S: Final = 120.0

WANTED = (
    Wanted("together.ratio_to_bare", at_least=0.5),
    Wanted("alone.ratio_to_bare", at_least=0.5),
    Wanted("not_in_the_database", at_most=0),
)


class Load:
    """Orders for one server, and which of them it has acknowledged."""

    def __init__(self, server: Server, cookies: list[str], recipient: str) -> None:
        self._server = server
        self._visitors = [Visitor(server.port, cookie) for cookie in cookies]
        self._recipient = recipient
        self._count = 0
        self.acknowledged: list[str] = []
        self.rates: dict[int, list[float]] = {}
        self.took_s: dict[int, list[float]] = {}
        self.processor_ms: dict[int, list[float]] = {}

    async def round(self, at_once: int, seconds: float) -> None:
        begun_s, used_s = time.perf_counter(), self._server.processor_s()
        before = len(self.acknowledged)
        took_s = self.took_s.setdefault(at_once, [])
        await asyncio.gather(*(self._order_until(v, begun_s + seconds, took_s) for v in self._visitors[:at_once]))
        rate = (len(self.acknowledged) - before) / (time.perf_counter() - begun_s)
        self.rates.setdefault(at_once, []).append(rate)
        used_ms = (self._server.processor_s() - used_s) * 1e3
        self.processor_ms.setdefault(at_once, []).append(used_ms / (len(self.acknowledged) - before))
        self.close()  # before the server does: it keeps no idle connection for long

    async def _order_until(self, visitor: Visitor, end_s: float, took_s: list[float]) -> None:
        while (begun_s := time.perf_counter()) < end_s:
            self._count += 1
            wish = {"from_post": "loeb", "to_post": "library", "recipient": self._recipient, "description": "A letter"}
            answer = await visitor.post("/api/v1/orders", wish, f"Idempotency-Key: key-{self._count}\r\n")
            assert answer.status == 201, answer
            took_s.append(time.perf_counter() - begun_s)
            self.acknowledged.append(answer.json()["id"])

    def forget(self) -> None:
        for measured in (self.rates, self.took_s, self.processor_ms):
            measured.clear()

    def close(self) -> None:
        for visitor in self._visitors:
            visitor.close()


def measure(samples: Samples) -> dict[str, Any]:
    with samples.folder() as folder:
        ours, theirs = folder / "service", folder / "bare"

        async def people(filling: Filling) -> list[Account]:
            return await filling.people(AT_ONCE + 1)

        accounts: list[Account] = fill(ours, people)
        with service(ours) as server, bare(theirs) as plain:
            return asyncio.run(_measure(samples, server, plain, accounts, folder))


async def _measure(
    samples: Samples, server: Server, plain: Server, accounts: list[Account], folder: Path
) -> dict[str, Any]:
    recipient, cookies = accounts[-1].person.email, [account.cookie for account in accounts[:-1]]
    own, other = Load(server, cookies, recipient), Load(plain, cookies, recipient)
    seconds = samples.seconds / (2 * samples.rounds)
    database = folder / "service" / "campus-mail.sqlite"
    settled_s = []
    for load in (own, other):
        await load.round(1, 0.5)  # what is made at the first request is made now
        load.forget()
    for number in range(samples.rounds):
        for at_once in (1, AT_ONCE):
            for load in (other, own):
                await load.round(at_once, seconds)
                settled_s.append(await _settle(database))
            per_s, bare_per_s = own.rates[at_once][-1], other.rates[at_once][-1]
            say(f"  round {number + 1}, {at_once} at once: {per_s:.0f}/s beside {bare_per_s:.0f}/s")
    return {
        "alone": _beside(own, other, 1),
        "together": {"people": AT_ONCE, **_beside(own, other, AT_ONCE)},
        "acknowledged": len(own.acknowledged),
        "not_in_the_database": _missing(database, own.acknowledged)
        + _missing(folder / "bare" / "bare.sqlite", other.acknowledged),
        "longest_until_all_notices_are_out_s": round(max(settled_s), 2),
        "memory": server.memory_mib(),
    }


def _beside(own: Load, other: Load, at_once: int) -> dict[str, Any]:
    rates, bare_rates = own.rates[at_once], other.rates[at_once]
    ratios = [mine / theirs for mine, theirs in zip(rates, bare_rates, strict=True)]
    return {
        "per_s": middle(rates),
        "bare_per_s": middle(bare_rates),
        "ratio_to_bare": middle(ratios),
        "processor_ms": middle(own.processor_ms[at_once]),
        "bare_processor_ms": middle(other.processor_ms[at_once]),
        "took": times(own.took_s[at_once]),
        "bare_took": times(other.took_s[at_once]),
    }


async def _settle(database: Path) -> float:
    """Wait until the notices of these orders are out, so that the next round is not measured beside their sending."""
    begun_s = time.perf_counter()
    with sqlite3.connect(database) as connection:
        waiting = "SELECT count(*) FROM outbox WHERE sent_at IS NULL"
        await until(lambda: not connection.execute(waiting).fetchone()[0], SETTLES_WITHIN_S)
    connection.close()
    return time.perf_counter() - begun_s


def _missing(database: Path, acknowledged: list[str]) -> int:
    with sqlite3.connect(database) as connection:
        kept = {row[0] for row in connection.execute("SELECT id FROM orders")}
    connection.close()
    return len(set(acknowledged) - kept) + len(acknowledged) - len(set(acknowledged))
