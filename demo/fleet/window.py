"""A page beside the product's: what robots report and where they truly are, and buttons that kill their processes.

The demonstration's own process serves it, on this machine alone, below a name that only its terminal shows. The product
knows nothing of it; the page draws the product's map with the product's modules.
"""

import asyncio
import secrets
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import uvicorn
from fastapi import FastAPI, HTTPException, Request
from fastapi.responses import PlainTextResponse
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.staticfiles import StaticFiles

from app.http.page_files import PageFiles, add_page_files
from app.http.pages import NPM_PACKAGES, SafeHeaders, import_map_hashes
from demo.fleet.places import TruePlaces
from demo.fleet.robots import RobotProcesses
from demo.fleet.settings import FleetDemo
from demo.fleet.truth import agreement, on_track, true_places
from demo.people import SimulatedPerson
from demo.settings import MAILROOM, DemoFailed
from maps import CampusMap
from protocol.clock import Clock
from robot.simulated import TruePose

FILES: Final = Path(__file__).parent / "window_files"
HERE: Final = "127.0.0.1"


class FleetWindow:
    """The page of one demonstration, at `url`. It reads what the mailroom may read, and the simulated world."""

    def __init__(
        self, demo: FleetDemo, campus: CampusMap, clock: Clock, places: TruePlaces, robots: RobotProcesses
    ) -> None:
        self._demo, self._campus, self._clock, self._places, self._robots = demo, campus, clock, places, robots
        self._name = secrets.token_urlsafe(16)
        self._mailroom = SimulatedPerson(MAILROOM, demo)
        self._listening = socket.create_server((HERE, 0))

    @property
    def url(self) -> str:
        return f"http://{HERE}:{self._listening.getsockname()[1]}/{self._name}/"

    async def serve(self) -> None:
        """Until cancelled; requests that are being answered come to their end first."""
        config = uvicorn.Config(
            self._app(), log_config=None, access_log=False, lifespan="off", timeout_graceful_shutdown=1
        )
        server = _Server(config)
        await self._mailroom.sign_in()
        serving = asyncio.ensure_future(server.serve(sockets=[self._listening]))
        try:
            await asyncio.shield(serving)
        finally:
            server.should_exit = True
            await serving
            await self._mailroom.close()

    def _app(self) -> FastAPI:
        app = FastAPI(openapi_url=None)
        app.add_exception_handler(DemoFailed, _is_ending)
        for method, path, answer in (
            ("GET", "map", self._mailroom.map),
            ("GET", "state", self._state),
            ("POST", "robots/{robot}/kill", self._kill),
            ("POST", "robots/{robot}/start", self._start),
        ):
            app.add_api_route(f"/{self._name}/{path}", answer, methods=[method])
        app.mount(f"/{self._name}", StaticFiles(directory=FILES, html=True))
        _add_parts_of_pages(app, self._demo.service.pages)
        hashes = " ".join(import_map_hashes([FILES / "index.html"]))
        policy = f"default-src 'self'; script-src 'self' {hashes}; base-uri 'none'; frame-ancestors 'none'"
        app.add_middleware(SafeHeaders, policy=policy)
        app.add_middleware(TrustedHostMiddleware, allowed_hosts=[HERE])
        return app

    async def _state(self) -> dict[str, Any]:
        """What the pages know, beside what is true."""
        mailroom = self._mailroom
        robots, traffic, alarms = await asyncio.gather(mailroom.robots(), mailroom.traffic(), mailroom.alarms())
        reported = {one["robot"]: one for one in traffic["reported"]}
        return {
            "now": self._clock.utc().isoformat(),
            "robots": robots,
            "traffic": traffic,
            "alarms": [alarm for alarm in alarms if alarm["cleared_at"] is None],
            "true": {name: self._truth(pose, reported.get(name)) for name, pose in self._places.poses.items()},
            "processes": {
                robot: {"number": number, "runs": robot not in self._robots.down}
                for robot, number in self._robots.ids.items()
            },
        }

    def _truth(self, pose: TruePose, reported: dict[str, Any] | None) -> dict[str, Any]:
        return {
            **asdict(on_track(self._campus, pose)),
            "places": sorted(true_places(self._campus, pose)),
            "agreement": agreement(self._campus, reported, pose),
        }

    async def _kill(self, robot: str) -> None:
        self._robots.kill(self._known(robot))

    async def _start(self, robot: str) -> None:
        self._robots.start_again(self._known(robot))

    def _known(self, robot: str) -> str:
        if robot not in self._demo.homes:
            raise HTTPException(404, "There is no such robot in this demonstration.")
        return robot


async def _is_ending(request: Request, failure: Exception) -> PlainTextResponse:
    """Answer for a service that has ended, as the demonstration does then."""
    return PlainTextResponse(str(failure), 503)


class _Server(uvicorn.Server):
    """Leaves signals to the demonstration, which stops everything in order."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


def _add_parts_of_pages(app: FastAPI, pages: Path) -> None:
    add_page_files(app, PageFiles(pages))
    app.mount("/src", StaticFiles(directory=pages / "src"))
    app.mount("/icons", StaticFiles(directory=pages / "public" / "icons"))
    for package in NPM_PACKAGES:
        app.mount(f"/npm/{package}", StaticFiles(directory=pages / "node_modules" / package))
