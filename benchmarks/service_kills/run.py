"""One run: a service under load, killed again and again, then left in peace until all is delivered, then judged."""

import asyncio
import signal
import time
from collections import Counter
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import AsyncExitStack, ExitStack, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any, Final

import httpx
from sqlalchemy import create_engine

from app.cli.administration import enrol
from app.core.settings import Settings
from app.models import metadata
from app.retention.database_checks import problems_of
from benchmarks.service_kills.judge import Facts, judged, mails_repeated
from benchmarks.service_kills.mail_server import Mailbox, SpoolFolder, is_sign_in, mail_server
from benchmarks.service_kills.people import Everybody, Person
from benchmarks.service_kills.senders import Sender
from benchmarks.service_kills.stand_in import StandIn
from benchmarks.service_kills.victim import Victim
from maps import read_map
from maps.ways import Ways

DOMAIN: Final = "campus.example"
RECIPIENTS: Final = tuple(f"recipient{n}@{DOMAIN}" for n in range(3))
STANDS_STILL_S: Final = 60.0
"""Whatever is owed then, after so long without any of it being done, would never have been done."""
WHILE_STARTING: Final = 0.15
"""So many kills strike before the service is up again."""
ORDERLY: Final = (0, -signal.SIGTERM)
"""Uvicorn ends in order and then dies of the signal that it was sent."""


@dataclass(frozen=True)
class Plan:
    """The amount of everything; a seed fixes when the kills come, and the machine what they hit."""

    kills: int = 300
    seed: int = 1
    senders: int = 3
    robots: int = 4
    order_pause_s: float = 0.15
    longest_s: float = 1.5
    with_smtp: bool = True


async def killed(plan: Plan, folder: Path, say: Callable[[int], None] = lambda kills: None) -> dict[str, Any]:
    """Run and return the result: counts, and under `wrong` a sentence for everything that must not be."""
    with ExitStack() as closing:
        server = closing.enter_context(mail_server()) if plan.with_smtp else None
        mailbox: Mailbox = server or SpoolFolder(folder / "data" / "spool")
        victim = Victim(folder, server.port if server else None)
        closing.callback(victim.end)
        tokens = await _enrolled(plan, victim)
        victim.start()
        await victim.is_up()
        async with AsyncExitStack() as browsers:
            scene = _Scene(plan, victim, mailbox, tokens, browsers)
            await scene.play(say)
        exit_code = await victim.stop()
        return scene.report(exit_code)


async def _enrolled(plan: Plan, victim: Victim) -> dict[str, str]:
    """The robots' tokens."""
    settings = Settings(data=victim.folder / "data")
    return {name: await enrol(settings, name, again=False) for name in (f"r{n}" for n in range(1, plan.robots + 1))}


class _Scene:
    """Everybody who takes part in a run."""

    def __init__(
        self, plan: Plan, victim: Victim, mailbox: Mailbox, tokens: Mapping[str, str], browsers: AsyncExitStack
    ) -> None:
        self._plan, self._victim, self._mailbox, self._browsers = plan, victim, mailbox, browsers
        self._senders = [
            Sender(**self._person(f"sender{n}@{DOMAIN}"), recipients=RECIPIENTS, pause_s=plan.order_pause_s)
            for n in range(plan.senders)
        ]
        self._recipients = [Person(**self._person(email)) for email in RECIPIENTS]
        self._robots = self._stand_ins(tokens)
        self._over = False
        self._struck: Counter[str] = Counter()
        self._drained = False

    def _person(self, email: str) -> dict[str, Any]:
        browser = httpx.AsyncClient()
        self._browsers.push_async_callback(browser.aclose)
        return {"url": self._victim.url, "email": email, "random": self._random(email), "http": browser}

    def _random(self, name: str) -> Random:
        return Random(f"{self._plan.seed}/{name}")

    def _stand_ins(self, tokens: Mapping[str, str]) -> list[StandIn]:
        ways = Ways(read_map(self._victim.map_file))
        posts, show = sorted(ways.campus.posts), Everybody(self._senders, self._recipients).show
        return [
            StandIn(name, token, self._victim.link_url, posts[n % len(posts)], ways, self._random(name), show)
            for n, (name, token) in enumerate(tokens.items())
        ]

    async def play(self, say: Callable[[int], None]) -> None:
        """Load, kills, and peace at the end."""
        await asyncio.gather(*(one.sign_in(self._mailbox) for one in self._recipients))
        async with self._robots_driving():
            async with asyncio.TaskGroup() as group:
                for sender in self._senders:
                    group.create_task(self._send(sender))
                await self._have_ordered()
                await self._kill(say)
                await self._have_ordered()
                self._over = True
            self._drained = await self._all_is_done()

    @asynccontextmanager
    async def _robots_driving(self) -> AsyncIterator[None]:
        tasks = [asyncio.create_task(robot.run()) for robot in self._robots]
        try:
            yield
        finally:
            for task in tasks:
                task.cancel()
            results = await asyncio.gather(*tasks, return_exceptions=True)
            for robot, result in zip(self._robots, results, strict=True):
                if not isinstance(result, asyncio.CancelledError):
                    robot.errors.append(f"it broke: {result!r}")

    async def _send(self, sender: Sender) -> None:
        await sender.sign_in(self._mailbox)
        await sender.order_until(lambda: self._over)

    async def _have_ordered(self) -> None:
        """Everybody has an answer to one order more: before the first kill since it is orders that are to be hit, and
        after the last since people go on."""
        before = [len(sender.acknowledged) for sender in self._senders]
        while any(len(sender.acknowledged) <= n for sender, n in zip(self._senders, before, strict=True)):  # noqa: ASYNC110
            await asyncio.sleep(0.05)

    async def _kill(self, say: Callable[[int], None]) -> None:
        random = Random(f"{self._plan.seed}/kills")
        for number in range(1, self._plan.kills + 1):
            if random.random() < WHILE_STARTING:
                self._struck["starting"] += 1
                await asyncio.sleep(random.uniform(0, self._plan.longest_s))
            else:
                self._struck["serving"] += 1
                await self._victim.is_up()
                await asyncio.sleep(random.uniform(0, self._plan.longest_s))
            self._victim.kill()
            self._victim.start()
            say(number)
        await self._victim.is_up()

    async def _all_is_done(self) -> bool:
        """Robots idle and heard, and nothing owed to anybody; False if it stands still before that."""
        most, since_s = -1, time.monotonic()
        while True:
            done, owed = await asyncio.to_thread(self._done_and_owed)
            if not owed and all(robot.is_idle for robot in self._robots):
                return True
            # What is owed may grow meanwhile: each order that goes on has more to tell.
            if done > most:
                most, since_s = done, time.monotonic()
            if time.monotonic() > since_s + STANDS_STILL_S:
                return False
            await asyncio.sleep(0.2)

    def _done_and_owed(self) -> tuple[int, int]:
        """Return the number of orders that are over, and of those that people still wait for."""
        tables = self._tables("orders", "notices", "outbox", "server_outbox")
        is_over = [
            *(row["state"] in ("delivered", "cancelled", "expired") for row in tables["orders"]),
            *(row["routed_at"] is not None for row in tables["notices"]),
            *(row["sent_at"] is not None for row in tables["outbox"]),
            *(row["acked_at"] is not None for row in tables["server_outbox"]),
        ]
        return sum(is_over), len(is_over) - sum(is_over)

    def _tables(self, *names: str) -> dict[str, list[dict[str, Any]]]:
        engine = create_engine(f"sqlite:///{self._victim.folder / 'data' / 'campus-mail.sqlite'}")
        try:
            with engine.connect() as connection:
                selects = {name: metadata.tables[name].select() for name in names or metadata.tables}
                return {name: [dict(row) for row in connection.execute(s).mappings()] for name, s in selects.items()}
        finally:
            engine.dispose()

    def _problems(self) -> list[str]:
        engine = create_engine(f"sqlite:///{self._victim.folder / 'data' / 'campus-mail.sqlite'}")
        try:
            with engine.connect() as connection:
                return problems_of(connection)
        finally:
            engine.dispose()

    def _facts(self) -> Facts:
        return Facts(
            tables=self._tables(),
            acknowledged={key: order_id for sender in self._senders for key, order_id in sender.acknowledged.items()},
            said={r.name: {seq: m.model_dump(mode="json") for seq, m in r.said.items()} for r in self._robots},
            mail_ids=[str(mail["Message-ID"]).strip() for mail in self._mailbox.mails() if not is_sign_in(mail)],
        )

    def report(self, exit_code: int) -> dict[str, Any]:
        facts = self._facts()
        wrong = [*judged(facts), *self._problems()]
        wrong += [sentence for sender in self._senders for sentence in sender.wrong]
        wrong += [f"{robot.name} was told off: {sentence}" for robot in self._robots for sentence in robot.errors]
        wrong += (
            [] if self._drained else [f"not everything was done, and nothing more for {STANDS_STILL_S:.0f} s of peace"]
        )
        wrong += [] if exit_code in ORDERLY else [f"the last stop ended with exit code {exit_code}"]
        return {
            "kills": sum(self._struck.values()),
            "struck": dict(self._struck),
            "mails_by": "smtp" if self._plan.with_smtp else "spool",
            "orders": len(facts.acknowledged),
            "requests": sum(one.tried for one in (*self._senders, *self._recipients)),
            "answers_replayed": sum(sender.replayed for sender in self._senders),
            "robot_messages": sum(len(said) for said in facts.said.values()),
            "robot_connections": sum(robot.connections for robot in self._robots),
            "notices": len(facts.tables["notices"]),
            "mails": len(facts.mail_ids),
            "mails_repeated_under_their_id": mails_repeated(facts),
            "wrong": wrong,
        }
