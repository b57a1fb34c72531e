"""Settings of a demonstration, and its errors."""

import json
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.accounts.demo_links import Page, link_path
from app.core.server_key import open_server_key
from app.core.settings import Settings

SENDER, RECIPIENT = "sender@campus.example", "recipient@campus.example"
MAILROOM, TECHNICIAN = "mailroom@campus.example", "technician@campus.example"
FROM_POST, TO_POST = "post1", "post4"
ROBOT = "r1"
ONCE_SPEED = 30.0
"""The robot's process lowers it to what it keeps up with."""
WATCHED_SPEED = 4.0
HANDS_ON_SPEED = 2.0
LIMIT_S = 180.0
"""Real time: an order that is not delivered by then has failed."""
LOW_RATIO = 0.2
# Charging a Create 2 takes two hours: with --low-battery the pack is small and the charger strong (assumed).
ROBOT_CONFIG = """
[battery]
simulated_capacity_mah = 600
simulated_charger_ma = 15000
"""


def default_speed(once: bool, hands_on: bool) -> float:
    """As fast as it keeps up where no person waits for the end; slower for eyes, slowest for hands."""
    if once:
        return ONCE_SPEED
    return HANDS_ON_SPEED if hands_on else WATCHED_SPEED


class DemoFailed(Exception):
    """Something did not happen, or a process died; the sentence says what."""


@dataclass(frozen=True)
class Demonstration:
    """A demonstration with one robot or several. Everything lies in `folder`; the door is apart,
    since socket paths must be short."""

    folder: Path
    door: Path
    port: int
    speed: float
    once: bool
    as_json: bool

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def clock_file(self) -> Path:
        return self.folder / "clock"

    def link(self, email: str, page: Page) -> str:
        """Return a link that opens a page as this person, in this demonstration alone."""
        return self.url + link_path(open_server_key(self.service.server_key_path), email, page)

    def token_file(self, robot: str) -> Path:
        return self.folder / f"{robot}.token"

    @property
    def map(self) -> str:
        """A built-in one by name, or a file."""
        return "test_track"

    @property
    def more(self) -> dict[str, Any]:
        """Settings of the service that only this kind of demonstration has."""
        return {}

    @property
    def service(self) -> Settings:
        """The service's settings in this demonstration."""
        return Settings(
            port=self.port,
            data=self.folder / "service",
            map=self.map,
            allowed_domains=("campus.example",),
            public_url=self.url,
            clock_file=self.clock_file,
            demo_door=self.door,
            # People read codes in real time, whatever the clock of the demonstration does.
            sign_in_code_lifetime_s=600 * self.speed,
            rate_limits=dict.fromkeys(("sign_in_codes_per_address", "sign_in_codes_per_host"), "1000 per minute"),
            **self.more,
        )

    def service_command(self) -> list[str]:
        return [sys.executable, "-m", "app", "serve", "--port", str(self.port)]

    def service_environment(self) -> dict[str, str]:
        """The settings as the service's process reads them."""
        settings = self.service.model_dump(mode="json", exclude_unset=True)
        ours = {f"CAMPUS_MAIL_{name.upper()}": value for name, value in settings.items()}
        inherited = {name: value for name, value in os.environ.items() if not name.startswith("CAMPUS_MAIL_")}
        return {**inherited, **{name: _as_text(value) for name, value in ours.items()}}

    def command_of(self, robot: str, data: Path, door: Path, more: Mapping[str, str]) -> list[str]:
        """Return the command that starts a robot with a simulated body."""
        options = {
            "--map": self.map,
            "--name": robot,
            "--server": f"ws://127.0.0.1:{self.port}/api/v1/robots/link",
            "--token-file": str(self.token_file(robot)),
            "--data": str(data),
            "--clock": str(self.clock_file),
            "--door": str(door),
            **more,
        }
        return [sys.executable, "-m", "robot", "--simulated", *(word for pair in options.items() for word in pair)]


@dataclass(frozen=True)
class Demo(Demonstration):
    """The one of the first letter, with one robot on the paper's track."""

    low_battery: bool
    hands_on: bool

    @property
    def robot_config(self) -> Path:
        return self.folder / "robot.toml"

    def robot_command(self) -> list[str]:
        more = {"--config": str(self.robot_config)} if self.low_battery else {}
        return self.command_of(ROBOT, self.folder / "robot", self.door, more)


def _as_text(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value)
