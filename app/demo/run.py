"""Runs a demonstration: starts what it needs, lets the story happen, stops everything again."""

import asyncio
import json
import os
import signal
from collections.abc import AsyncIterator, Coroutine
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from typing import Any

import httpx

from app.administration import enrol
from app.demo.children import Children
from app.demo.people import Spool
from app.demo.screen import Screen
from app.demo.settings import LIMIT_S, ROBOT, ROBOT_CONFIG, Demo, DemoFailed
from app.demo.story import Story
from app.serving import listen
from protocol.clock import SharedClock

READY_LIMIT_S = 60.0
LOOK_EVERY_S = 0.1
A_MOMENT_S = 0.5
EXIT_FAILED = 1
EXIT_INTERRUPTED = 130


def run(demo: Demo) -> int:
    """The exit code. Raises StartError, a taken port above all, before anything is started."""
    with listen("127.0.0.1", demo.port) as free:
        demo = replace(demo, port=free.getsockname()[1])  # 0 takes a free one
    return asyncio.run(_run(demo))


async def _run(demo: Demo) -> int:
    spool = Spool(demo.service.spool_folder)
    screen = Screen(demo, spool)
    stop = _stop_signal()
    try:
        return await _until(stop, _play(demo, spool, screen), EXIT_INTERRUPTED if demo.once else 0)
    except DemoFailed as failure:
        if demo.as_json:
            print(json.dumps({"ok": False, "reason": str(failure)}))  # noqa: T201  # the one object on stdout
        screen.failed(str(failure))
        return EXIT_FAILED


def _stop_signal() -> asyncio.Event:
    stop = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    return stop


async def _until(stop: asyncio.Event, play: Coroutine[Any, Any, int], interrupted: int) -> int:
    """Let it play until it ends or somebody stops it."""
    playing, stopping = asyncio.ensure_future(play), asyncio.ensure_future(stop.wait())
    try:
        await asyncio.wait([playing, stopping], return_when=asyncio.FIRST_COMPLETED)
        return playing.result() if playing.done() else interrupted
    finally:
        for task in (playing, stopping):
            task.cancel()
        with suppress(DemoFailed):
            await asyncio.gather(playing, stopping, return_exceptions=True)


async def _play(demo: Demo, spool: Spool, screen: Screen) -> int:
    clock = SharedClock.create(demo.clock_file, demo.speed)
    demo.robot_config.write_text(ROBOT_CONFIG)
    await _write_token(demo)
    children = Children()
    try:
        await _perform(demo, children, Story(demo, clock, spool, screen.see_order), screen)
    finally:
        await children.stop()
    return 0


async def _perform(demo: Demo, children: Children, story: Story, screen: Screen) -> None:
    service = await children.start(
        "service", demo.service_command(), demo.folder / "service.log", demo.service_environment()
    )
    async with _beside([service.watch(), _print_codes(screen)]):
        await _is_ready(demo)
        screen.welcome()
        robot = await children.start("robot", demo.robot_command(), demo.folder / "robot.log")
        async with _beside([robot.watch()]):
            try:
                await _tell_story(demo, story, screen)
            except DemoFailed as failure:
                # If a child has died that is the better reason: its watcher cancels us here.
                await asyncio.sleep(A_MOMENT_S)
                if demo.once:
                    raise
                screen.failed(str(failure))
            if not demo.once:
                screen.go_on()
                await asyncio.Event().wait()


async def _tell_story(demo: Demo, story: Story, screen: Screen) -> None:
    try:
        async with asyncio.timeout(LIMIT_S if demo.once else None):
            summary = await story.deliver()
    except TimeoutError:
        raise DemoFailed(f"The letter was not delivered within {LIMIT_S:.0f} s.") from None
    finally:
        await story.close()
    if demo.as_json:
        print(json.dumps(summary, indent=2))  # noqa: T201  # the one object on stdout
    screen.delivered(summary)


@asynccontextmanager
async def _beside(watchers: list[Coroutine[Any, Any, None]]) -> AsyncIterator[None]:
    """What goes on beside the story; a watcher that fails ends the story with its own error."""
    try:
        async with asyncio.TaskGroup() as group:
            tasks = [group.create_task(watcher) for watcher in watchers]
            yield
            for task in tasks:
                task.cancel()
    except BaseExceptionGroup as group:
        raise _cause(group) from None


def _cause(group: BaseExceptionGroup[BaseException]) -> BaseException:
    """What failed, out of the group that asyncio wraps it in."""
    failed = group.subgroup(DemoFailed) or group
    first = failed.exceptions[0]
    return _cause(first) if isinstance(first, BaseExceptionGroup) else first


async def _write_token(demo: Demo) -> None:
    """Enrol the robot and keep its token where only it and we can read it."""
    database = demo.service.data / "campus-mail.sqlite"
    token = await enrol(demo.service, ROBOT, again=database.exists())
    descriptor = os.open(demo.token_file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(descriptor, "w") as file:
        file.write(token)


async def _is_ready(demo: Demo) -> None:
    try:
        async with asyncio.timeout(READY_LIMIT_S), httpx.AsyncClient() as http:
            while not await _answers(http, demo):  # noqa: ASYNC110  # another process has no event of ours
                await asyncio.sleep(LOOK_EVERY_S)
    except TimeoutError:
        raise DemoFailed(f"The service was not ready within {READY_LIMIT_S:.0f} s.") from None


async def _answers(http: httpx.AsyncClient, demo: Demo) -> bool:
    with suppress(httpx.HTTPError):
        return (await http.get(f"{demo.url}/readyz")).is_success
    return False


async def _print_codes(screen: Screen) -> None:
    while True:
        screen.see_mails()
        await asyncio.sleep(LOOK_EVERY_S)
