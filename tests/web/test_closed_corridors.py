"""Closed corridors on the pages: closing, reopening, and releasing those of a lost robot."""

import re

import pytest
from playwright.async_api import expect

from protocol.parts import Activity, Battery, Leg
from protocol.to_server import CommandAnswer, Event, Fault, Snapshot, Why
from robot.agent.actions.corridors import WAY_BLOCKED, tried_again, turned_back
from tests.app.robots.playing import at_post
from tests.web.keyboard import press

pytestmark = pytest.mark.browser
MAILROOM = "/mailroom.html"


@pytest.mark.nightly
async def test_a_corridor_that_a_robot_found_closed_is_open_again_when_a_dispatcher_who_has_looked_says_so(
    quiet_campus, robot, visit
):
    dana = await quiet_campus.dispatcher(visit)
    page = dana.page
    told = {"name": WAY_BLOCKED, "happened_at": robot.clock.utc(), "post": "post3"}
    reason = turned_back(Leg(from_post="post3", to_post="post4"), "blocked")
    await robot.ends(await robot.say(Event(happened=Fault(reason=reason, **told))))
    await page.goto(MAILROOM)
    way, wrong = (page.get_by_role("region", name=name) for name in ("The paper's test track", "Issues"))
    in_words = "The robot turned back in the corridor from Post 3 to Post 4. Something stands in it."
    await expect(wrong.get_by_text(in_words)).to_be_visible()
    await expect(wrong.get_by_role("button", name=re.compile(r"^Mark as open\W+Post 3 – Post 4"))).to_be_visible()
    await expect(way.locator(".shut[data-corridor]")).to_have_count(1)
    await expect(way.get_by_text("Closed to robots")).to_be_visible()
    await way.get_by_text("Text description").click()
    since = re.compile("^The corridor between Post 3 and Post 4 was blocked at ")
    await expect(way.get_by_text(since)).to_be_visible()

    await press(page, r"Acknowledge\W+Robot")  # and goes there to look
    await expect(page.get_by_text(f"Acknowledged: {in_words}")).to_be_visible()
    await press(page, rf"Post 3 – Post 4 is open\W+{robot.name}")
    await expect(page.get_by_role("button", name="Yes, it is open")).to_be_focused()
    await dana.assert_accessible()
    await page.keyboard.press("Enter")
    wish = (await robot.hear("open_way")).body
    assert set(wish.ends) == {"post3", "post4"}
    await expect(page.get_by_text("has been told that the corridor between Post 3 and Post 4 is open.")).to_be_visible()
    await expect(way.locator(".shut[data-corridor]")).to_have_count(1)  # until it says so itself

    answer = {"command_id": wish.command_id, "happened_at": robot.clock.utc()}
    await robot.say(Event(happened=CommandAnswer(accepted=True, **answer)))
    await robot.say(Event(happened=Fault(cleared=True, reason=tried_again("post3-post4"), **told)))
    await robot.say(Why(sentence="Driving towards post4"))
    await expect(way.locator(".shut[data-corridor]")).to_have_count(0, timeout=40_000)
    await expect(page.get_by_role("button", name="Post 3 – Post 4 is open")).to_have_count(0)


@pytest.mark.slow
async def test_a_corridor_is_closed_and_opened_and_the_way_of_a_robot_that_stands_is_freed_by_keyboard_alone(
    quiet_campus, robot, visit
):
    dana = await quiet_campus.dispatcher(visit)
    page = dana.page
    await quiet_campus.scene.lets_wait(robot.name, "post5", "post3", for_robot="r2", minutes=30)
    await page.goto(MAILROOM)
    waits = re.compile(r"^Waiting for corridor Post 5 – Post 3, occupied by r2 until about \d")
    await expect(page.get_by_role("region", name=re.compile("^Robots")).get_by_text(waits)).to_be_visible()
    closed = page.get_by_role("region", name="Closed corridors")
    await expect(closed.get_by_text("All corridors are open.")).to_be_visible()
    await press(page, "Close a corridor")
    await expect(page.get_by_label("Reason")).to_be_focused()
    await page.keyboard.type("The floor is wet")
    await page.keyboard.press("Shift+Tab")
    await page.keyboard.press("ArrowDown")
    await dana.assert_accessible()
    await page.keyboard.press("Enter")
    await expect(closed.get_by_role("listitem")).to_contain_text(["Post 2 – Post 3 The floor is wet"])
    await expect(page.locator("campus-map .shut[data-corridor=post2-post3]")).to_have_count(1)
    await press(page, "Reopen")
    await page.keyboard.press("Enter")
    await expect(closed.get_by_text("All corridors are open.")).to_be_visible()

    await robot.say(Snapshot(position=at_post("post5"), activity=Activity.STOPPED, battery=Battery(ratio=0.9)))
    await press(page, rf"Release its corridors\W+{robot.name}")
    await page.keyboard.press("Enter")
    assert (await robot.hear("revoke")).body.reason == "Checked on site; it blocks no corridor"
    await expect(page.get_by_text(f"Robot {robot.name} stays out of the traffic until it stands")).to_be_visible()
    await expect(page.get_by_text("Its corridors were given to others; it takes part again").first).to_be_visible()


@pytest.mark.slow
async def test_from_a_robots_page_too_it_is_told_that_a_corridor_is_open_and_what_cannot_be_is_said(
    quiet_campus, robot, visit
):
    dana = await quiet_campus.dispatcher(visit, locale="fr-CA")
    dana.refusals_expected.add(f"/api/v1/robots/{robot.name}/open-way")
    page = dana.page
    told = {"name": WAY_BLOCKED, "reason": turned_back(Leg(from_post="post2", to_post="post3"), "virtual_wall")}
    fault = Fault(happened_at=robot.clock.utc(), **told)
    await robot.ends(await robot.say(Event(happened=fault)))
    await page.goto(f"/robots.html?robot={robot.name}")
    in_french = re.compile("Le robot a fait demi-tour dans le couloir de .* Un mur virtuel le garde")
    await expect(page.locator(".closed-ways").get_by_text(in_french)).to_be_visible()
    await expect(page.get_by_role("region", name="Pannes et alarmes").get_by_text(in_french)).to_be_visible()
    await dana.assert_accessible()
    await press(page, "Signaler comme ouvert")
    await robot.ends(await robot.say(Event(happened=fault.model_copy(update={"cleared": True}))))
    await robot.socket.close()
    await expect(page.get_by_text("Hors ligne").first).to_be_visible()
    await page.keyboard.press("Enter")
    await expect(page.get_by_text(f"Le robot {robot.name} est hors ligne.")).to_be_visible()
