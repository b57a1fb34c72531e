"""The follow page for a long time: what changes is drawn, nothing else, and nothing is left behind."""

import asyncio
import re
from collections.abc import AsyncIterator, Iterator

import pytest
import pytest_asyncio
from playwright.async_api import CDPSession, Page, expect

from protocol.parts import Activity, Battery, Leg, Position
from protocol.to_server import Claim, Clear, Snapshot, Step, Why
from tests.app.robots.playing import PlayedRobot
from tests.web.service import Service

pytestmark = pytest.mark.browser

CHANGES = 300
ROUNDS = 4
"""Leaks grow with each round of changes. What the browser itself holds on to for a while
(34 nodes were seen, in one round of many) is not."""
QUIET_S = 1.5
# The engine goes on compiling what runs often: some 100 kB in the first hundreds of changes, ever less after that.
WARM_UP, HEAP_SLACK_BYTES = 100, 400_000
MORE_TO_SAY = 30
"""Nodes: the page may say more at the end than at the beginning, as when the robot is expected. Three hundred changes
that leave something behind leave hundreds."""
MAY_GROW = {"Detached": 5, "Nodes": MORE_TO_SAY, "JSEventListeners": 0, "JSHeapUsedSize": HEAP_SLACK_BYTES}
WAY = ("post5", "post3", "post2", "post1")
LEG = Leg(from_post="post3", to_post="post2")


@pytest.fixture(scope="module")
def roads(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("roads")) as service:
        yield service


@pytest_asyncio.fixture(loop_scope="session")
async def robot(roads: Service) -> AsyncIterator[PlayedRobot]:
    async with roads.connected("r1") as robot:
        yield robot


async def drives_about(robot: PlayedRobot, changes: int, battery: float) -> None:
    """Seen here and there, for one reason or another; at last at post5 with this much in its battery."""
    for number in reversed(range(changes)):
        post, towards = WAY[number % len(WAY)], WAY[(number + 1) % len(WAY)]
        position = Position(post=post, towards=towards, seen_at=robot.clock.utc())
        ratio = battery if number == 0 else 0.3 + number % 50 / 100
        activity = Activity.DRIVING if number % 5 == 0 else Activity.WAITING
        await robot.say(Snapshot(position=position, activity=activity, battery=Battery(ratio=ratio)))
        await robot.say(Why(sentence=f"Driving towards {towards}"))
        await asyncio.sleep(0.012)


async def many_changes(page: Page, browser: CDPSession, robot: PlayedRobot) -> None:
    """Until the page has heard of so many of them: what comes at once is told at once."""
    heard: list[str] = []

    def note(event: dict[str, str]) -> None:
        heard.append(event["eventName"])

    browser.on("Network.eventSourceMessageReceived", note)
    while heard.count("robot") < CHANGES:
        await drives_about(robot, 50, battery=0.92)
        await battery_is(page, 92)
    browser.remove_listener("Network.eventSourceMessageReceived", note)


async def left_behind(page: Page, browser: CDPSession) -> dict[str, float]:
    """Count the objects once all changes are drawn, which takes a moment, and all that is held no more is gone; as
    "Detached" the nodes that are on no page any more."""
    before, now = None, await held(page, browser)
    while before != now["Nodes"]:
        await asyncio.sleep(QUIET_S)
        before, now = now["Nodes"], await held(page, browser)
    return now


async def held(page: Page, browser: CDPSession) -> dict[str, float]:
    for _ in range(3):
        await browser.send("HeapProfiler.collectGarbage")
    metrics = {one["name"]: one["value"] for one in (await browser.send("Performance.getMetrics"))["metrics"]}
    return {**metrics, "Detached": metrics["Nodes"] - await page.evaluate(ON_THE_PAGE)}


ON_THE_PAGE = """() => {
  const nodes = document.createTreeWalker(document);
  let count = 0;
  while (nodes.nextNode()) count += 1;
  return count;
}"""


CHANGED = """(map) => new Promise((told) => {
  const places = [];
  const observer = new MutationObserver((changes) => places.push(...changes.map(({target}) => {
    const element = target.nodeType === Node.TEXT_NODE ? target.parentElement : target;
    return element?.closest(".note, .facts")?.getAttribute("class") ?? element?.outerHTML.slice(0, 80) ?? "gone";
  })));
  observer.observe(map, {subtree: true, childList: true, attributes: true, characterData: true});
  setTimeout(() => (observer.disconnect(), told(places)), 2_500);
})"""


async def battery_is(page: Page, percent: int) -> None:
    await expect(page.get_by_text(f"Battery {percent}%")).to_be_visible()


@pytest.mark.nightly
async def test_after_hundreds_of_changes_the_page_is_as_light_as_before(visit, roads: Service, robot: PlayedRobot):
    ada = await visit(at=roads)
    page = ada.page
    order_id = await ada.order("bob.martin@campus.example")
    mission = await robot.mission()
    await robot.ends(await robot.report(mission, Step.ACCEPTED))
    await drives_about(robot, 1, battery=0.9)
    await page.goto(f"/follow.html?order={order_id}")
    facts = page.get_by_role("region", name="Robot location")
    await expect(facts.get_by_text(re.compile("^Last seen at"))).to_be_visible()

    await robot.say(Claim(claim_id="c1", legs=(LEG,)))
    await expect(facts.get_by_text(re.compile("^May be in the corridor from Post 3 to Post 2, since"))).to_be_visible()
    await expect(facts.locator("path.taken[data-robot]")).to_have_count(1)
    await robot.say(Clear(leg=LEG))
    await expect(facts.locator("path.taken[data-robot]")).to_have_count(0)

    browser = await page.context.new_cdp_session(page)
    await browser.send("Performance.enable")
    for percent in (
        90,
        91,
    ):  # what is drawn for the first time brings its template; where the robot is expected comes late
        await drives_about(robot, WARM_UP, battery=percent / 100)
        await battery_is(page, percent)
        before = await left_behind(page, browser)
    await browser.send("Network.enable")
    grown = []
    for _ in range(ROUNDS):
        await many_changes(page, browser, robot)
        after = await left_behind(page, browser)
        grown.append(
            {name: after[name] - before[name] for name in MAY_GROW if after[name] - before[name] > MAY_GROW[name]}
        )
        if not grown[-1]:
            break
        before = after
    assert not grown[-1], grown

    await expect(facts.get_by_text(re.compile(r"^Last seen at Post 5, \d+ sec"))).to_be_visible()
    changed = await page.locator("campus-map").evaluate(CHANGED)
    assert changed, "ages grow"
    assert set(changed) <= {"note", "facts"}, "and nothing else is drawn again"
