"""The surroundings of every demonstration: waits for the service, watches its processes, ends when told to."""

import asyncio
import json
import os
import signal
from collections.abc import AsyncIterator, Callable, Coroutine, Mapping
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import httpx

from app.cli.administration import change_roles, enrol
from app.core.settings import Settings
from app.models import Role
from demo.settings import MAILROOM, TECHNICIAN, DemoFailed
from demo.terminal import Terminal

READY_LIMIT_S = 60.0
LOOK_EVERY_S = 0.1
EXIT_FAILED = 1
EXIT_INTERRUPTED = 130


async def played(play: Coroutine[Any, Any, int], screen: Terminal, as_json: bool, interrupted: int) -> int:
    """The exit code of what plays until it ends, fails or is stopped; `interrupted` is that of the last."""
    try:
        return await _until(_stop_signal(screen.stopping), play, interrupted)
    except DemoFailed as failure:
        if as_json:
            print(json.dumps({"ok": False, "reason": str(failure)}))  # noqa: T201  # the one object on stdout
        screen.failed(str(failure))
        return EXIT_FAILED


def _stop_signal(stopping: Callable[[], None]) -> asyncio.Event:
    stop = asyncio.Event()

    def told() -> None:
        if not stop.is_set():
            stopping()
        stop.set()

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        asyncio.get_running_loop().add_signal_handler(number, told)
    return stop


async def _until(stop: asyncio.Event, play: Coroutine[Any, Any, int], interrupted: int) -> int:
    """Let it play until it ends or is stopped."""
    playing, stopping = asyncio.ensure_future(play), asyncio.ensure_future(stop.wait())
    try:
        await asyncio.wait([playing, stopping], return_when=asyncio.FIRST_COMPLETED)
        return playing.result() if playing.done() else interrupted
    finally:
        for task in (playing, stopping):
            task.cancel()
        with suppress(DemoFailed):
            await asyncio.gather(playing, stopping, return_exceptions=True)


@asynccontextmanager
async def beside(watchers: list[Coroutine[Any, Any, None]]) -> AsyncIterator[None]:
    """Run what goes on beside the story; a watcher that fails ends the story with its own error."""
    try:
        async with asyncio.TaskGroup() as group:
            tasks = [group.create_task(watcher) for watcher in watchers]
            yield
            for task in tasks:
                task.cancel()
    except BaseExceptionGroup as group:
        raise _cause(group) from None


def _cause(group: BaseExceptionGroup[BaseException]) -> BaseException:
    """Return the failure, out of the group that asyncio wraps it in."""
    failed = group.subgroup(DemoFailed) or group
    first = failed.exceptions[0]
    return _cause(first) if isinstance(first, BaseExceptionGroup) else first


async def write_tokens(settings: Settings, files: Mapping[str, Path]) -> None:
    """Enrol each robot and keep its token where only it and we can read it."""
    again = (settings.data / "campus-mail.sqlite").exists()
    for robot, file in files.items():
        token = await enrol(settings, robot, again)
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        with os.fdopen(descriptor, "w") as opened:
            opened.write(token)


async def give_roles(settings: Settings) -> None:
    """Make the dispatcher and the maintainer, for a visitor who opens the pages as one of them."""
    await change_roles(settings, MAILROOM, [Role.DISPATCHER], [])
    await change_roles(settings, TECHNICIAN, [Role.MAINTAINER], [])


async def is_ready(url: str) -> None:
    try:
        async with asyncio.timeout(READY_LIMIT_S), httpx.AsyncClient() as http:
            while not await _answers(http, url):  # noqa: ASYNC110  # another process has no event of ours
                await asyncio.sleep(LOOK_EVERY_S)
    except TimeoutError:
        raise DemoFailed(f"The service was not ready within {READY_LIMIT_S:.0f} s.") from None


async def _answers(http: httpx.AsyncClient, url: str) -> bool:
    with suppress(httpx.HTTPError):
        return (await http.get(f"{url}/readyz")).is_success
    return False
