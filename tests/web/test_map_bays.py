"""The map where posts have bays: each robot is drawn in what it reports to be in."""

import re
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack

import pytest
import pytest_asyncio
from playwright.async_api import Locator, Page, expect

from maps import builtin_map
from protocol.clock import RealClock
from protocol.parts import Position
from protocol.to_server import Occupancy, Where
from tests.app.robots.playing import PlayedRobot
from tests.app.traffic.bay_travelling import UNDERSTANDS
from tests.web.drawn import expect_drawn
from tests.web.mailroom_scene import Scene
from tests.web.service import Service
from tests.web.test_map import overlap

pytestmark = pytest.mark.browser
HOMES = ("uc_bay1", "canal_bay1", "loeb_bay1")


@pytest.fixture(scope="module")
def tunnels(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("tunnels"), campus="carleton") as service:
        yield service


@pytest_asyncio.fixture(loop_scope="session", scope="module")
async def robots(tunnels: Service) -> AsyncIterator[list[PlayedRobot]]:
    """Three that the test plays, in their homes."""
    async with AsyncExitStack() as connections:
        played = [PlayedRobot(RealClock(), f"r{n}", journal=f"journal-{n}") for n in (1, 2, 3)]
        for robot, home in zip(played, HOMES, strict=True):
            await connections.enter_async_context(robot.connected(tunnels.link, await tunnels.enrol_robot(robot.name)))
            seen = Position(post=home, seen_at=robot.clock.utc() if robot.name == "r3" else None)
            await robot.greet(home, home=home, understands=UNDERSTANDS, position=seen)
            await report(robot, "bay", home)
        yield played


async def report(robot: PlayedRobot, where: Where, post: str, towards: str | None = None) -> None:
    told = Occupancy(where=where, post=post, towards=towards, evidence="marker", happened_at=robot.clock.utc())
    await robot.ends(await robot.say(told))


async def mailroom(visit, tunnels: Service, **options: str) -> Page:
    dana = await visit("dana.desk", at=tunnels, **options)
    await Scene(tunnels, campus="carleton").make_dispatcher(dana.email)
    await dana.page.goto("/mailroom.html")
    await comes_to_map(dana.page)
    return dana.page


async def comes_to_map(page: Page) -> None:
    """The map is fetched when it comes into view."""
    await page.get_by_role("heading", name="The Carleton tunnels").scroll_into_view_if_needed()


def drawn(page: Page, robot: str, **at: str) -> Locator:
    return page.locator(f".robot[data-robot={robot}]" + "".join(f"[data-{key}={value}]" for key, value in at.items()))


async def middle(locator: Locator) -> tuple[float, float]:
    box = await locator.bounding_box()
    assert box
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


@pytest.mark.parametrize("device", ["phone", "desk"])
async def test_a_robot_is_drawn_in_the_bay_the_crossing_and_the_corridor_that_it_reports(
    visit, tunnels, robots, device
):
    first, second, _ = robots
    await report(first, "bay", "uc_bay1")
    await report(second, "bay", "uc_bay2")
    page = await mailroom(visit, tunnels, on=device, locale="en-CA")
    for robot, bay in (("r1", "uc_bay1"), ("r2", "uc_bay2"), ("r3", "loeb_bay1")):
        at, end = (
            await middle(drawn(page, robot, bay=bay).locator(".body")),
            await middle(page.locator(f"g[data-bay={bay}]:not(.robot)")),
        )
        assert at == pytest.approx(end, abs=2)
    await report(first, "crossing", "uc")
    await expect(drawn(page, "r1", post="uc")).not_to_have_attribute("data-bay", re.compile("."))
    _, uc = await middle(drawn(page, "r1").locator(".body"))
    bodies = [await drawn(page, robot).locator(".body").bounding_box() for robot in ("r1", "r2")]
    assert not overlap(*[list(box.values()) for box in bodies if box]), "two at one post do not hide each other"
    await report(first, "corridor", "uc", "canal")
    await expect(drawn(page, "r1", corridor="canal-uc")).to_be_visible()
    _, y = await middle(drawn(page, "r1").locator(".body"))
    _, canal = await middle(page.locator("g[data-bay=canal_bay1]:not(.robot)"))  # east of the post
    assert canal + 10 < y < uc - 10, "between the two"
    await page.reload()
    await comes_to_map(page)
    await expect(drawn(page, "r1", corridor="canal-uc")).to_be_visible()


@pytest.mark.parametrize(
    ("locale", "corridor", "bay", "place"),
    [
        (
            "en-CA",
            "In the corridor from UC (Nideyinàn) to Canal since",
            "In bay 1 at Loeb since",
            "Loeb (bay 1: home, bay 2, bay 3)",
        ),
        (
            "fr-CA",
            "Dans le couloir de UC (Nideyinàn) à Canal depuis",
            "À l’emplacement 1 de Loeb depuis",
            "attitré, avec station de charge",
        ),
    ],
)
async def test_the_list_says_what_the_drawing_shows(visit, tunnels, robots, locale, corridor, bay, place):
    await report(robots[0], "corridor", "uc", "canal")
    await report(robots[2], "bay", "loeb_bay1")
    page = await mailroom(visit, tunnels, locale=locale)
    await expect(drawn(page, "r1", corridor="canal-uc")).to_be_visible()
    said = await page.locator("campus-map .map-told").evaluate("(told) => told.textContent")
    assert corridor in said and bay in said and place in said
    await expect(page.locator("campus-map .legend li")).to_have_count(3)


async def test_a_report_of_a_place_that_this_map_does_not_have_is_not_drawn_there(visit, tunnels, robots):
    """As after the map was changed: the robot is drawn where it was last seen."""
    page = await mailroom(visit, tunnels)
    await page.route("**/api/v1/map/traffic", lambda route: route.fulfill(json=ELSEWHERE))
    await page.reload()
    await comes_to_map(page)
    await expect(drawn(page, "r3", post="loeb")).to_be_visible()
    await expect(drawn(page, "r3")).not_to_have_attribute("data-bay", re.compile("."))


async def test_the_marker_sheets_of_a_post_are_printed_with_those_of_its_bays(visit, tunnels):
    page = await mailroom(visit, tunnels)
    await page.goto("/print.html")
    sheets = page.locator("img.marker-sheet")
    track = builtin_map("carleton").track
    await expect(sheets).to_have_count(sum(len(place.markers) for place in track.posts.values()))
    for box in await page.get_by_role("group", name="Posts with their bays").get_by_role("checkbox").all():
        if await box.get_attribute("value") != "uc":
            await box.uncheck()
    await expect(page.get_by_role("checkbox", name="UC (Nideyinàn) 8 sheets")).to_be_checked()
    await expect(page.get_by_role("img", name="Marker sheet for UC (Nideyinàn), bay 1")).to_have_count(2)
    await expect(page.get_by_role("img", name="Marker sheet for UC (Nideyinàn), bay 2")).to_have_count(1)
    await expect(sheets).to_have_count(8)
    for sheet in await sheets.all():
        await expect_drawn(sheet)


AT = "2026-01-05T09:00:00Z"
ELSEWHERE = {"taken": [], "reported": [{"robot": "r3", "kind": "bay", "place": "gone_bay1", "towards": None, "at": AT}]}
