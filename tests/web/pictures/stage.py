"""Where the pictures are taken: the real service on the map of the tunnels, on a morning that does not pass."""

import subprocess
import sys
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from playwright.async_api import Browser, Playwright

from protocol.clock import SharedClock
from tests.web.service import ROOT, Service
from tests.web.visitor import Visitor

MOMENT: Final = datetime(2026, 10, 14, 14, 24, tzinfo=UTC)
ZONE: Final = "America/Toronto"
CAMPUS: Final = "carleton"
HOME: Final = "commons"
"""Of the robot that drives; without one it would have the first dock, which is another robot's."""
STANDS_STILL: Final = 1e-6
DRIVES: Final = 3.0
"""Simulated seconds in one of ours, while a robot is to be seen driving."""
SCREENS: Final[dict[str, dict[str, Any]]] = {
    "phone": {"viewport": {"width": 412, "height": 840}, "device_scale_factor": 1.5},
    "desk": {"viewport": {"width": 1280, "height": 860}},
}


def screen(playwright: Playwright, name: str) -> dict[str, Any]:
    """Options of a browser context; phones less sharp than they are, so that pictures stay small."""
    phone = {key: value for key, value in playwright.devices["Pixel 7"].items() if key != "default_browser_type"}
    return {**(phone if name == "phone" else {}), **SCREENS[name]}


@dataclass
class Stage:
    """The service, its clock, and the people at their screens."""

    service: Service
    clock: SharedClock
    browser: Browser
    playwright: Playwright
    context: dict[str, Any] = field(default_factory=dict)
    _people: AsyncExitStack = field(default_factory=AsyncExitStack)
    _known: dict[tuple[str, str], Visitor] = field(default_factory=dict)

    async def visitor(self, who: str, on: str) -> Visitor:
        """A visitor at a screen, signed in unless called "anonymous"; the same one when asked for again."""
        if (who, on) not in self._known:
            options = {"locale": "en-CA", "timezone_id": ZONE, "service_workers": "block", "reduced_motion": "reduce"}
            options |= screen(self.playwright, on) | self.context
            visitor = Visitor(self.browser, self.service, f"{who}@campus.example", options)
            await self._people.enter_async_context(visitor)
            self._known[who, on] = visitor if who == "anonymous" else await visitor.sign_in()
        return self._known[who, on]

    async def leave(self) -> None:
        await self._people.aclose()

    @contextmanager
    def robot_drives(self, name: str, token: str) -> Iterator[None]:
        """A daemon with a simulated body, as anybody would start it. Time passes as long as it is there."""
        token_file = self.service.folder / f"{name}.token"
        token_file.write_text(token)
        token_file.chmod(0o600)
        settings = self.service.folder / f"{name}.toml"
        settings.write_text(f'home = "{HOME}"\n')
        command = [sys.executable, "-m", "robot", "run", "--config", str(settings), "--simulated"]
        command += ["--name", name, "--map", CAMPUS]
        command += ["--server", self.service.link, "--token-file", str(token_file)]
        command += ["--data", str(self.service.folder / name), "--clock", str(self.service.folder / "clock")]
        self.clock.set_speed(DRIVES)
        with (self.service.folder / f"{name}.log").open("wb") as log:
            process = subprocess.Popen(command, cwd=ROOT, stdout=log, stderr=log)
        try:
            yield
        finally:
            process.terminate()
            process.wait(10)
            self.clock.set_speed(STANDS_STILL)


@asynccontextmanager
async def set_up(folder: Path, browser: Browser, playwright: Playwright, **context: Any) -> AsyncIterator[Stage]:
    """A service whose data lies in `folder`, from start to stop. `context`: what every browser is told besides."""
    clock = SharedClock.create(folder / "clock", STANDS_STILL, starts_at=MOMENT)
    more = {"CAMPUS_MAIL_CLOCK_FILE": str(folder / "clock"), "CAMPUS_MAIL_TIME_ZONE": ZONE}
    with Service(folder, CAMPUS, more=more) as service:
        stage = Stage(service, clock, browser, playwright, context)
        try:
            yield stage
        finally:
            await stage.leave()
