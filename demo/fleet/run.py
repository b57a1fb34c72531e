"""Runs a demonstration of the fleet: service and robots, people who order, an eye on where robots truly are."""

import asyncio
import json
import time
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import replace
from typing import Any

from app.cli.serving import listen
from demo.beside import EXIT_INTERRUPTED, LOOK_EVERY_S, beside, give_roles, is_ready, played, write_tokens
from demo.children import Children
from demo.fleet.campus_life import CampusLife
from demo.fleet.places import TruePlaces
from demo.fleet.robots import RobotProcesses
from demo.fleet.screen import FleetScreen
from demo.fleet.settings import FleetDemo
from demo.fleet.window import FleetWindow
from demo.people import Spool
from demo.settings import DemoFailed
from maps import find_map
from protocol.clock import SharedClock

A_MOMENT_S = 0.5
PLACES_EVERY_S = 0.02
LONG_S = 600.0
"""Of the demonstration's clock: if no robot has moved for so long while there is work, that is said."""


def run(demo: FleetDemo) -> int:
    """The exit code. Raises StartError, a taken port above all, before anything is started."""
    with listen("127.0.0.1", demo.port, "fleet-demo") as free:
        demo = replace(demo, port=free.getsockname()[1])  # 0 takes a free one
    return asyncio.run(_run(demo))


async def _run(demo: FleetDemo) -> int:
    demo.lay_out()
    clock = SharedClock.create(demo.clock_file, demo.speed)
    screen = FleetScreen(demo, clock, Spool(demo.service.spool_folder))
    goes_on = not demo.once and demo.minutes is None
    return await played(_play(demo, clock, screen), screen, demo.as_json, 0 if goes_on else EXIT_INTERRUPTED)


async def _play(demo: FleetDemo, clock: SharedClock, screen: FleetScreen) -> int:
    screen.step("Making the database …")
    await write_tokens(demo.service, {robot: demo.token_file(robot) for robot in demo.homes})
    await give_roles(demo.service)
    children = Children()
    try:
        await _perform(demo, clock, children, screen)
    finally:
        await children.stop()
    return 0


async def _perform(demo: FleetDemo, clock: SharedClock, children: Children, screen: FleetScreen) -> None:
    screen.step("Starting the service …")
    service = await children.start(
        "service", demo.service_command(), demo.folder / "service.log", demo.service_environment()
    )
    async with beside([service.watch()]):
        await is_ready(demo.url)
        screen.welcome()
        screen.step(f"Starting the robots {', '.join(demo.homes)} …")
        robots = RobotProcesses(demo, clock, children, screen.say)
        await robots.start()
        screen.name_processes(robots.ids)
        campus = find_map(demo.map)
        places = TruePlaces(campus, demo.world_file, demo.folder / "true_poses.csv", demo.ghosts)
        life = CampusLife(demo, clock, screen.say)
        course = Course(demo, clock, life, places, robots)
        with closing(places):
            async with beside([course.look_at_places()]):
                try:
                    async with beside([robots.must_live()]):
                        await life.begin()
                    window = FleetWindow(demo, campus, clock, places, robots)
                    async with beside([robots.look_after(), window.serve()]):
                        screen.show_window(window.url)
                        await course.live(screen)
                except DemoFailed:
                    # If the service has died that is the better reason: its watcher cancels us here.
                    await asyncio.sleep(A_MOMENT_S)
                    raise
                finally:
                    await life.close()


class Course:
    """The course of one demonstration, and its figures."""

    def __init__(
        self, demo: FleetDemo, clock: SharedClock, life: CampusLife, places: TruePlaces, robots: RobotProcesses
    ) -> None:
        self._demo, self._clock, self._life, self._places, self._robots = demo, clock, life, places, robots
        self._began_real_s, self._began_s = time.monotonic(), clock.now()
        self._longest_still_s = 0.0

    async def live(self, screen: FleetScreen) -> None:
        self._began_real_s, self._began_s = time.monotonic(), self._clock.now()
        screen.begin()
        async with beside([self._life.watch_alarms(), self._look_at_movement(screen.say), self._draw(screen)]):
            await self._orders()
        figures = self.figures()
        if self._demo.as_json:
            print(json.dumps(figures, indent=2))  # noqa: T201  # the one object on stdout
        screen.end(sentence_of(figures))

    async def _orders(self) -> None:
        if self._demo.once:
            try:
                async with asyncio.timeout(self._demo.once_limit_s):
                    await self._life.once()
            except TimeoutError:
                limit_s = self._demo.once_limit_s
                raise DemoFailed(f"Orders were not delivered within {limit_s:.0f} s: {self._left()}.") from None
            return
        with suppress(TimeoutError):
            async with asyncio.timeout(None if self._demo.minutes is None else self._demo.minutes * 60.0):
                await self._life.go_on()

    def _left(self) -> str:
        return "; ".join(f"{order['state']}, {order['why']}" for order in self._life.orders.values())

    async def look_at_places(self) -> None:
        """Check the true places, more often than two bodies can be through each other."""
        while True:
            self._places.look()
            await asyncio.sleep(PLACES_EVERY_S)

    async def _look_at_movement(self, say: Callable[[str], None]) -> None:
        moves, since_s, is_said = self._places.moves, self._clock.now(), False
        while True:
            now_s = self._clock.now()
            if self._places.moves != moves or not self._life.is_there_work():
                moves, since_s, is_said = self._places.moves, now_s, False
            self._longest_still_s = max(self._longest_still_s, now_s - since_s)
            if now_s - since_s > LONG_S and not is_said:
                is_said = True
                say(f"STANDSTILL: no robot has moved for {LONG_S / 60:.0f} min: {self._left()}")
            await asyncio.sleep(LOOK_EVERY_S)

    async def _draw(self, screen: FleetScreen) -> None:
        while True:
            screen.see_mails()
            screen.show(self._life, self._places, self._robots.down)
            await asyncio.sleep(LOOK_EVERY_S)

    def figures(self) -> dict[str, Any]:
        """Of the whole run; `simulated_s` by the demonstration's clock."""
        life, places = self._life, self._places
        return {
            "ok": True,
            "robots": len(self._demo.homes),
            "died": dict(self._robots.died),
            "placed": life.placed,
            "ended": dict(life.ended),
            "delivered_by": dict(life.delivered_by),
            "open": len(life.orders),
            "corridors_entered_or_left": places.moves,
            "most_corridors_in_use_at_once": places.most_at_once,
            "looks_at_true_places": places.looks,
            "two_in_one_corridor": places.met,
            "bodies_touched": places.judge.touches,
            "bodies_overlapped": len(places.judge.overlaps),
            "collisions": [str(one) for one in places.judge.found],
            "longest_standstill_s": round(self._longest_still_s),
            "alarms": life.alarms,
            "simulated_s": round(self._clock.now() - self._began_s),
            "wall_s": round(time.monotonic() - self._began_real_s, 1),
        }


def sentence_of(figures: dict[str, Any]) -> str:
    """Return the result in a sentence."""
    ended = ", ".join(f"{count} {state}" for state, count in sorted(figures["ended"].items())) or "none ended"
    return (
        f"Of {figures['placed']} orders in {figures['simulated_s'] / 60:.0f} simulated minutes "
        f"({figures['wall_s'] / 60:.1f} real ones): {ended}, {figures['open']} open. Up to "
        f"{figures['most_corridors_in_use_at_once']} corridors in use at once. At {figures['looks_at_true_places']} "
        f"looks, two robots were in one corridor {figures['two_in_one_corridor']} times, and bodies touched "
        f"{figures['bodies_touched']} times, {figures['bodies_overlapped']} of them overlapping."
    )
