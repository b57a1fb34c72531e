"""Runs a demonstration: starts what it needs, lets the story happen, stops everything again."""

import asyncio
import json
from dataclasses import replace

from app.cli.serving import listen
from demo.beside import EXIT_INTERRUPTED, LOOK_EVERY_S, beside, give_roles, is_ready, played, write_tokens
from demo.children import Children
from demo.people import Spool
from demo.screen import Screen
from demo.settings import LIMIT_S, ROBOT, ROBOT_CONFIG, Demo, DemoFailed
from demo.story import Story
from protocol.clock import SharedClock

A_MOMENT_S = 0.5


def run(demo: Demo) -> int:
    """The exit code. Raises StartError, a taken port above all, before anything is started."""
    with listen("127.0.0.1", demo.port, "demo") as free:
        demo = replace(demo, port=free.getsockname()[1])  # 0 takes a free one
    return asyncio.run(_run(demo))


async def _run(demo: Demo) -> int:
    spool = Spool(demo.service.spool_folder)
    screen = Screen(demo, spool)
    interrupted = EXIT_INTERRUPTED if demo.once else 0
    return await played(_play(demo, spool, screen), screen, demo.as_json, interrupted)


async def _play(demo: Demo, spool: Spool, screen: Screen) -> int:
    clock = SharedClock.create(demo.clock_file, demo.speed)
    screen.step("Making the database …")
    demo.robot_config.write_text(ROBOT_CONFIG)
    await write_tokens(demo.service, {ROBOT: demo.token_file(ROBOT)})
    await give_roles(demo.service)
    children = Children()
    try:
        await _perform(demo, children, Story(demo, clock, spool, screen.see_order), screen)
    finally:
        await children.stop()
    return 0


async def _perform(demo: Demo, children: Children, story: Story, screen: Screen) -> None:
    screen.step("Starting the service …")
    service = await children.start(
        "service", demo.service_command(), demo.folder / "service.log", demo.service_environment()
    )
    async with beside([service.watch(), _print_codes(screen)]):
        await is_ready(demo.url)
        screen.welcome()
        screen.step("Starting the robot …")
        robot = await children.start("robot", demo.robot_command(), demo.folder / "robot.log")
        async with beside([robot.watch()]):
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


async def _print_codes(screen: Screen) -> None:
    while True:
        screen.see_mails()
        await asyncio.sleep(LOOK_EVERY_S)
