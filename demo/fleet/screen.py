"""The terminal of a fleet demonstration: a line for each robot, and the latest events."""

from collections import deque
from collections.abc import Mapping, Set
from datetime import datetime
from typing import Any

from rich.console import Group
from rich.live import Live
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from demo.fleet.campus_life import CampusLife
from demo.fleet.errands import address
from demo.fleet.places import TruePlaces
from demo.fleet.settings import FleetDemo
from demo.people import Spool
from demo.terminal import Terminal
from protocol.clock import SharedClock

LAST_EVENTS = 12
SOLID = "If two overlapped or were in one corridor, by their true places, this would end with an error."
GHOSTS = "They pass through each other; how often is counted by their true places, and ends nothing."
TO_FETCH = {"assigned", "to_sender", "at_sender"}


class FleetScreen(Terminal):
    """A table that stays and changes on a terminal, lines anywhere else."""

    def __init__(self, demo: FleetDemo, clock: SharedClock, spool: Spool) -> None:
        super().__init__(demo, spool)
        self._demo, self._clock = demo, clock
        self._events: deque[str] = deque(maxlen=LAST_EVENTS)
        self._live = Live(console=self._console, auto_refresh=False, transient=False)

    def welcome(self) -> None:
        demo = self._demo
        for line in (
            f"[bold]Campus Mail, the fleet[/], at [link]{demo.url}[/]: {len(demo.homes)} robots on the map "
            f"{escape(demo.campus.map.title)}, its corridors 1 : {1 / demo.scale:.3g} of their length",
            f"The bodies are simulated, in one world. {GHOSTS if demo.ghosts else SOLID}",
        ):
            self._console.print(line, soft_wrap=True)
        sender, recipient, *_ = map(address, demo.campus.offices)
        self.show_links(demo, sender, recipient)

    def name_processes(self, ids: Mapping[str, int]) -> None:
        named = ", ".join(f"{robot} {number}" for robot, number in ids.items())
        self.step(f"Their processes: {named}. Kill one (kill -9 NUMBER), and see what the service does.")

    def show_window(self, url: str) -> None:
        """A link to what only the demonstration has."""
        self._console.print(f"  {'fleet':<10}  [cyan]{url}[/]", soft_wrap=True)
        self._console.print(
            "The last one shows reported and true positions side by side, and kills processes. It is no part of the "
            "product.",
            soft_wrap=True,
        )

    def begin(self) -> None:
        if self._console.is_terminal:
            self._live.start()

    def say(self, line: str) -> None:
        told = f"{self._clock.utc().astimezone():%H:%M:%S}  {line}"
        self._events.append(told)
        if not self._live.is_started:
            self._console.print(escape(told), soft_wrap=True)

    def see_mails(self) -> None:
        """Say sign-in codes as they are mailed."""
        for sentence in self.new_codes():
            self.say(sentence)

    def show(self, life: CampusLife, places: TruePlaces, down: Set[str]) -> None:
        """`down`: robots whose process has died."""
        if self._live.is_started:
            self._live.update(self._picture(life, places, down), refresh=True)

    def _picture(self, life: CampusLife, places: TruePlaces, down: Set[str]) -> Group:
        table = Table(expand=True, box=None, padding=(0, 1))
        for heading in ("robot", "where", "mail", "battery", "what"):
            table.add_column(heading, overflow="fold", ratio=3 if heading == "what" else None)
        for robot in sorted(life.robots, key=lambda one: str(one["name"])):
            table.add_row(*row_of(robot, life.orders), style="red" if robot["name"] in down else None)
        ended = ", ".join(f"{count} {state}" for state, count in sorted(life.ended.items())) or "none ended"
        figures = (
            f"{self._clock.utc().astimezone():%H:%M:%S}, {self._clock.speed:.1f} times as fast   "
            f"orders: {len(life.orders)} open, {ended}   in corridors now: {places.inside}   "
            f"bodies touched: {places.judge.touches} times"
        )
        return Group(Text(figures, style="bold"), table, *(Text(line, style="dim") for line in self._events))

    def end(self, sentence: str) -> None:
        self._clear()
        self._console.print(sentence, soft_wrap=True)

    def _clear(self) -> None:
        self._live.stop()


def row_of(robot: Mapping[str, Any], orders: Mapping[str, Any]) -> tuple[str, str, str, str, str]:
    """A robot's line: name, where it was seen, its orders, its charge, what it does and why it waits."""
    seen, battery = robot["last_seen"], robot["battery"]
    where = seen["post"] if seen else "not seen yet"
    where += f" → {robot['towards']}" if robot["towards"] else ""
    mine = [order for order in orders.values() if order["robot"] and order["robot"]["name"] == robot["name"]]
    fetching = sum(order["state"] in TO_FETCH for order in mine)
    mail = f"{len(mine) - fetching} aboard" + (f", {fetching} to fetch" if fetching else "")
    charge = f"{battery['ratio']:.0%}{' charging' if battery['charging'] else ''}" if battery else "unknown"
    what = robot["why"] or robot["activity"]
    waits = robot["waits_for"]
    if waits and waits["until"]:
        what += f", until about {datetime.fromisoformat(waits['until']).astimezone():%H:%M:%S}"
    return robot["name"], where, mail, charge, what if robot["online"] else f"offline; {what}"
