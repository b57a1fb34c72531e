"""The page of the fleet demonstration: reported and true positions, and what happens when a robot's process dies."""

import re
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any

import httpx
import psutil
import pytest
import pytest_asyncio
from playwright.async_api import Page, async_playwright, expect

from maps import find_map
from maps.geometry import Point, distance_m
from robot.simulated import WorldFile
from tests.system.test_fleet_demo import Watched

pytestmark = [pytest.mark.system, pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(300)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fleet")


@pytest.fixture(scope="module")
def demo(folder: Path) -> Iterator[Watched]:
    """Two robots, at a speed at which they stay where they are for a moment."""
    watched = Watched("--speed", "2", "--restart-after", "600", "--data", str(folder))
    yield watched
    watched.process.terminate()
    assert watched.process.wait(20) == 0
    watched.close()
    assert "Traceback" not in watched.rest()


@pytest.fixture(scope="module")
def address(demo: Watched) -> str:
    return demo.says(r"^  fleet +(http://127\.0\.0\.1:\d+/[\w-]+/)$")[1]


@pytest_asyncio.fixture
async def page(address: str, browser_type_launch_args: dict[str, Any]) -> AsyncIterator[Page]:
    complaints: list[str] = []
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(**browser_type_launch_args)
        page = await (await browser.new_context(locale="en-CA")).new_page()
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        await page.goto(address)
        yield page
        await browser.close()
    assert complaints == []


async def test_the_switch_shows_where_the_bodies_are_in_the_simulated_world(page: Page, folder: Path) -> None:
    await expect(page.get_by_text("bodies and world are simulated")).to_be_visible()
    bodies = WorldFile(folder / "world")
    place = find_map(folder / "carleton.toml").track.post("uc_bay1")
    pose = bodies.poses()["r1"]
    bodies.close()
    assert place.dock
    assert distance_m(Point(pose.x_m, pose.y_m), Point(place.dock.x_m, place.dock.y_m)) < 1.0, "at home, by the file"
    row = page.get_by_role("row", name="r1")
    await expect(row).to_contain_text("bay uc_bay1")
    await expect(row.locator(".agrees")).to_have_text("agrees")
    ring, body = page.locator("[data-true=r1] circle"), page.locator(".robot[data-robot=r1] .body")
    assert distance(await box(ring), await box(body)) < 20.0, "true and reported position are drawn at one place"
    switch = page.get_by_role("switch", name="Show true positions (simulated world)")
    await switch.uncheck()
    await expect(page.locator("[data-true]")).to_have_count(0)
    await expect(page.get_by_role("columnheader", name="Truly")).to_have_count(0)
    await expect(body).to_be_visible()
    await switch.check()
    await expect(page.locator("[data-true]")).to_have_count(2)


async def box(locator: Any) -> tuple[float, float]:
    found = await locator.bounding_box()
    return found["x"] + found["width"] / 2, found["y"] + found["height"] / 2


def distance(a: tuple[float, float], b: tuple[float, float]) -> float:
    return float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5)


async def test_a_process_that_is_killed_leaves_its_body_and_is_started_again_on_request(
    page: Page, demo: Watched
) -> None:
    row = page.get_by_role("row", name="r2")
    number = int((re.search(r"runs \((\d+)\)", await row.inner_text()) or [0, 0])[1])
    assert "robot" in psutil.Process(number).cmdline()
    await row.get_by_role("button", name="Kill process").click()
    await expect(row).to_contain_text("killed or ended")
    demo.says(r"r2: its process was killed by signal 9")
    assert not psutil.pid_exists(number)
    await expect(page.locator("[data-true=r2]")).to_be_visible()
    await expect(page.locator(".robot[data-robot=r2]")).to_have_class(re.compile("offline"), timeout=60_000)
    await expect(page.get_by_role("row", name="r1")).to_contain_text("runs (")
    await row.get_by_role("button", name="Start again").click()
    again = int(demo.says(r"r2: started again, process (\d+)", 30.0)[1])
    await expect(row).to_contain_text(f"runs ({again})")
    assert psutil.pid_exists(again) and again != number
    await expect(page.locator(".robot[data-robot=r2]")).not_to_have_class(re.compile("offline"), timeout=60_000)


def test_only_this_machine_and_only_who_knows_its_name_gets_to_the_page(demo: Watched, address: str) -> None:
    place, name = address.rstrip("/").rsplit("/", 1)
    port = int(place.rsplit(":", 1)[1])
    listening = [one.laddr for one in psutil.Process(demo.process.pid).net_connections() if one.status == "LISTEN"]
    assert [(one.ip, one.port) for one in listening] == [("127.0.0.1", port)]
    with httpx.Client() as visitor:
        assert visitor.get(f"{address}state").status_code == 200
        assert visitor.get(f"{place}/state").status_code == 404
        assert visitor.get(f"{place}/{name[:-1]}/state").status_code == 404
        assert visitor.post(f"{place}/robots/r1/kill").status_code == 404
        assert visitor.post(f"{address}robots/r9/kill").status_code == 404
        assert visitor.get(f"{address}state", headers={"Host": "evil.example"}).status_code == 400
        product = f"http://127.0.0.1:{_port_of_service(demo)}"
        assert visitor.get(f"{product}/{name}/state").status_code == 404


def _port_of_service(demo: Watched) -> int:
    (service,) = (
        child for child in psutil.Process(demo.process.pid).children() if child.cmdline()[1:3] == ["-m", "app"]
    )
    (port,) = {one.laddr.port for one in service.net_connections() if one.status == "LISTEN"}
    return int(port)
