"""The terminal of a demonstration."""

from datetime import datetime
from typing import Any

from demo.people import Spool
from demo.settings import RECIPIENT, SENDER, Demo
from demo.terminal import Terminal

WORDS = {
    "queued": "ordered, waiting for a robot",
    "assigned": "a robot has taken it on",
    "to_sender": "the robot is on its way to the sender",
    "at_sender": "the robot waits for the sender's code",
    "carrying": "the mail is aboard",
    "at_recipient": "the robot waits for the recipient's code",
    "delivered": "delivered",
}


class Screen(Terminal):
    """Prints what is new, once."""

    def __init__(self, demo: Demo, spool: Spool) -> None:
        super().__init__(demo, spool)
        self._demo = demo
        self._events_seen = 0
        self._where = ""

    def welcome(self) -> None:
        speed = f"time runs {self._demo.speed:g} times as fast, or as fast as this machine keeps up"
        self._console.print(f"[bold]Campus Mail[/] at [link]{self._demo.url}[/]   (simulated: {speed})", soft_wrap=True)
        self.show_links(self._demo, SENDER, RECIPIENT)
        if self._demo.hands_on:
            self._console.print("Hands on: open the order on the page and show its codes to the camera yourself.")

    def see_order(self, order: dict[str, Any]) -> None:
        """Print the events that are new, and where the robot was last seen."""
        for event in order["events"][self._events_seen :]:
            place = f" at {event['post']}" if event["post"] else ""
            words = WORDS.get(event["state"], event["reason"] or "")
            self._console.print(
                f"{_clock_time(event['at'])}  [bold]{event['state']:<12}[/] {words}{place}", soft_wrap=True
            )
        self._events_seen = len(order["events"])
        self._see_robot(order["robot"])

    def _see_robot(self, robot: dict[str, Any] | None) -> None:
        seen = robot["last_seen"] if robot else None
        if robot is None or seen is None:
            return
        where = f"{seen['post']}, {robot['activity']}"
        if where != self._where:
            self._where = where
            battery = f", battery {robot['battery']['ratio']:.0%}" if robot["battery"] else ""
            why = f" – {robot['why']}" if robot["why"] else ""
            self._console.print(f"          [dim]{robot['name']} seen at {where}{battery}{why}[/]", soft_wrap=True)

    def see_mails(self) -> None:
        """Print sign-in codes as they are mailed."""
        for sentence in self.new_codes():
            self._console.print(f"          [cyan]{sentence}[/]", soft_wrap=True)

    def delivered(self, summary: dict[str, Any]) -> None:
        told = sum(sum(kinds.values()) for kinds in summary["notifications"].values())
        robot = summary["robot"]
        self._console.print(
            f"[green]Delivered[/] in {summary['wall_s']} s. "
            f"The robot drove {robot['distance_m']} m in {robot['time_s']} s of its own time "
            f"and searched for the line {robot['find_line_episodes']} times. {told} notices, each once.",
            soft_wrap=True,
        )

    def go_on(self) -> None:
        self._console.print(f"The page goes on at {self._demo.url}. Ctrl-C ends everything.")


def _clock_time(at: str) -> str:
    return datetime.fromisoformat(at).astimezone().strftime("%H:%M:%S")
