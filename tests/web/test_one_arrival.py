"""One time of arrival on every page, from a robot's own word to the screen; and a reason where there is none."""

import asyncio
import re
from collections.abc import AsyncIterator, Iterator
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
import pytest_asyncio
from playwright.async_api import Locator, Page, expect

from maps import builtin_map, shortest_route
from protocol.parts import Activity, Battery, Position, Stop, StopAction
from protocol.to_robot import Mission
from protocol.to_server import Snapshot, Step, Why
from tests.app.robots.playing import PlayedRobot
from tests.web.mailroom_scene import Scene
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

TRACK = builtin_map("test_track")
CORRIDOR_S = 2.0 / 0.15
MINUTE = timedelta(minutes=1)
TOLD = """() => {
  const text = (where) => document.querySelector(where)?.textContent.replace(/\\s+/g, " ").trim() ?? null;
  const facts = [...document.querySelectorAll("campus-map .facts li")].map((li) => li.textContent.trim());
  const told = facts.map((fact) => /^Expected at Post 4, (.*)$/.exec(fact)?.[1]).filter(Boolean);
  const notes = [...document.querySelectorAll("campus-map .label tspan")].map((note) => note.textContent.trim());
  const at = notes.indexOf("expected");
  const clean = (said) => said && said.replace(/\\s+/g, " ");
  const note = at < 0 ? null : clean(notes[at + 1]);
  return {hero: text(".window strong"), fact: clean(told[0] ?? null), note};
}"""


@pytest.fixture
def campus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("arrivals")) as service:
        yield service


@pytest_asyncio.fixture(loop_scope="session")
async def played(campus: Service) -> AsyncIterator[PlayedRobot]:
    async with campus.connected("r1") as robot:
        yield robot


async def is_seen(robot: PlayedRobot, post: str, towards: str | None, why: str = "") -> None:
    position = Position(post=post, towards=towards, seen_at=robot.clock.utc())
    activity = Activity.DRIVING if towards else Activity.WAITING
    await robot.say(Snapshot(position=position, activity=activity, battery=Battery(ratio=0.82)))
    if why:
        await robot.say(Why(sentence=why))


async def drives(robot: PlayedRobot, mission: Mission, stop: Stop, here: str) -> AsyncIterator[str]:
    """From post to post, each told as a robot tells it; after each word the pages are looked at."""
    posts = shortest_route(TRACK, here, stop.post).posts
    for at, post in enumerate(posts):
        step = Step.DEPARTED if at == 0 else Step.ARRIVED if at == len(posts) - 1 else Step.PASSED
        await robot.ends(await robot.report(mission, step, stop, post=post))
        await is_seen(robot, post, posts[at + 1] if at + 1 < len(posts) else None)
        yield post


async def estimate(person: Visitor, order_id: str) -> dict[str, Any]:
    view = await person.api(f"/orders/{order_id}")
    told: dict[str, Any] = view["estimate"]
    assert told["to"] is None or datetime.fromisoformat(told["to"]) > datetime.now(UTC) - timedelta(seconds=1), told
    return told


async def all_say_the_same(ada: Visitor, mail: Page, mailroom: Page, order_id: str) -> dict[str, Any]:
    """Hero, map and its list say the same at any moment; card and queue with them, as soon as the stream has come."""
    async with asyncio.timeout(30):
        while True:
            told = await ada.page.evaluate(TOLD)
            assert told["fact"] == told["hero"] == told["note"], told
            before, window = await estimate(ada, order_id), told["hero"]
            shown = [await said(mail.locator(".when").first), await said(mailroom.locator(".queue .when").first)]
            if before == await estimate(ada, order_id) and window and all(window in one for one in shown):
                return before
            await asyncio.sleep(0.3)


async def said(where: Locator) -> str:
    return re.sub(r"\s+", " ", await where.inner_text())


@pytest.mark.timeout(400)
@pytest.mark.nightly
async def test_every_place_says_the_same_time_at_each_step_and_the_robot_comes_when_it_was_said(
    campus, played, visit
) -> None:
    ada, desk = await visit("ada", on="desk", at=campus), await visit("grace", on="desk", at=campus)
    await Scene(campus).make_dispatcher(desk.email)
    order_id = await ada.order("bob.martin@campus.example")
    await ada.page.goto(f"/follow.html?order={order_id}")
    mail = await ada.new_page()
    await mail.goto("/mail.html")
    await desk.page.goto("/mailroom.html")
    mission = await played.mission()
    load, receive = mission.stops
    await all_say_the_same(ada, mail, desk.page, order_id)
    async for post in drives(played, mission, load, "post5"):
        assert post
        await all_say_the_same(ada, mail, desk.page, order_id)
    loaded_at = datetime.now(UTC)
    await played.ends(await played.say(played.receipt(load)))
    told = await all_say_the_same(ada, mail, desk.page, order_id)
    async for post in drives(played, mission, receive, load.post):
        if post == receive.post:
            break
        told = await all_say_the_same(ada, mail, desk.page, order_id)
        async with asyncio.timeout(60):
            left_at = datetime.now(UTC)
            while datetime.now(UTC) < left_at + timedelta(seconds=CORRIDOR_S):
                told = await all_say_the_same(ada, mail, desk.page, order_id)
    came_at = datetime.now(UTC)
    begins_at, ends_at = (datetime.fromisoformat(told[end]) for end in ("from", "to"))
    assert begins_at - MINUTE <= came_at <= ends_at + MINUTE, "pages say minutes"
    assert datetime.fromisoformat(told["made_at"]) > loaded_at, "renewed on the way"
    await expect(ada.page.get_by_role("heading", level=1)).to_contain_text("is waiting for Bob Martin at Post 4")
    assert (await ada.page.evaluate(TOLD))["hero"] is None, "what is over is not expected"


@pytest.mark.nightly
async def test_who_orders_while_the_only_robot_has_mail_that_was_not_taken_reads_that_and_no_time(
    campus, played, visit
) -> None:
    ada = await visit("ada", on="phone", at=campus)
    await ada.order("bob.martin@campus.example")
    mission = await played.mission()
    load, receive = mission.stops
    async for _ in drives(played, mission, load, "post5"):
        pass
    await played.ends(await played.say(played.receipt(load)))
    async for _ in drives(played, mission, receive, load.post):
        pass
    await played.ends(await played.report(mission, Step.GAVE_UP, receive, reason="no_one_came"))
    stop = Stop(id=f"return-{receive.order_id}", post="post1", action=StopAction.RETURN, order_id=receive.order_id)
    own = Mission(id="return-0123456789abcdef", update=1, stops=(stop,))
    await played.report(own, Step.ACCEPTED)
    for step in (Step.DEPARTED, Step.ARRIVED):
        await played.report(own, step, stop)
    await played.report(own, Step.GAVE_UP, stop, reason="no_one_came")
    await played.ends(await played.report(own, Step.GAVE_UP, None, post="post5", reason="no_one_came"))
    await is_seen(played, "post5", None, why="In its dock at post5")

    carl = await visit("carl", on="phone", at=campus)
    stuck = "No robot is free: the mailroom has to see to stuck mail first."
    async with asyncio.timeout(30):
        while (await carl.api("/estimate?from_post=post2&to_post=post3"))["reason"] != stuck:  # noqa: ASYNC110
            await asyncio.sleep(0.1)
    order_id = await carl.order("dora@campus.example", from_post="post2", to_post="post3")
    told = await estimate(carl, order_id)
    assert (told["from"], told["to"], told["reason"]) == (None, None, stuck)
    await carl.page.goto(f"/follow.html?order={order_id}")
    main = carl.page.locator("main")
    await expect(main).to_contain_text("The arrival time is not known yet.")
    await expect(main).to_contain_text(stuck)
    for wrong in ("Expected at", "nearest free robot", "Every robot is busy"):
        await expect(main).not_to_contain_text(wrong)
    await carl.page.goto("/notices.html")
    await expect(carl.page.locator("main")).to_contain_text("When it arrives is not known yet")
    await carl.assert_accessible()
