"""The robots' page, with a real daemon that drives through a simulated tunnel."""

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import pytest_asyncio
from playwright.async_api import Page, expect

from app.accounts.sign_in.service import find_person, set_roles
from app.core.database.database import Database
from app.core.settings import Settings
from app.models import Role
from tests.web.service import ROOT, Service
from tests.web.test_everywhere import NO_OVERFLOW, SMALL_TARGETS

pytestmark = pytest.mark.browser
SPEED = "3"
"""Simulated seconds in one of ours: to the first corner in a moment, and still driving at the end of a test."""


@pytest.fixture(scope="module")
def tunnel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("tunnel"), "test_track") as service:
        yield service


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def robot(tunnel: Service) -> str:
    token = tunnel.folder / "r1.token"
    token.write_text(await tunnel.enrol_robot("r1"))
    token.chmod(0o600)
    return str(token)


@pytest.fixture(scope="module")
def daemon(tunnel: Service, robot: str) -> Iterator[None]:
    """As anybody would start it."""
    command = [sys.executable, "-m", "robot", "run", "--simulated", "--name", "r1", "--map", "test_track"]
    command += ["--server", tunnel.link, "--token-file", robot, "--data", str(tunnel.folder / "r1"), "--speed", SPEED]
    with (tunnel.folder / "robot.log").open("wb") as log:
        process = subprocess.Popen(command, cwd=ROOT, stdout=log, stderr=log)
    yield
    process.terminate()
    process.wait(10)


async def give_roles(service: Service, email: str, *roles: Role) -> None:
    database = Database(Settings(data=service.folder).url_of_database)
    async with database.transaction() as session:
        person = await find_person(session, email)
        assert person is not None
        set_roles(person, set(roles), {Role.MAINTAINER, Role.DISPATCHER} - set(roles))
    await database.close()


async def walks_the_tree(page: Page) -> None:
    """With the arrows alone; Tab comes to the tree once, and on again."""
    tree = page.get_by_role("tree", name="Intentions")
    await expect(tree.locator("[tabindex='0']")).to_have_count(1)
    await page.get_by_role("button", name="Download log").focus()
    await page.keyboard.press("Tab")
    await expect(tree.locator(":focus")).to_have_count(1)
    first = tree.get_by_role("treeitem").first
    await page.keyboard.press("Home")
    await expect(first).to_be_focused()
    await expect(first).to_have_accessible_name(re.compile("^Intention "))
    await expect(first).to_have_attribute("aria-expanded", "true")
    goal = first.get_by_role("treeitem").first
    await page.keyboard.press("ArrowRight")
    await expect(goal).to_be_focused()
    await page.keyboard.press("ArrowLeft")
    if await first.evaluate("item => item !== document.activeElement"):  # the goal was open: first it is closed
        await page.keyboard.press("ArrowLeft")
    await expect(first).to_be_focused()
    await page.keyboard.press("ArrowLeft")
    await expect(first).to_have_attribute("aria-expanded", "false")
    await expect(goal).to_be_hidden()
    await page.keyboard.press("Enter")
    await expect(goal).to_be_visible()
    await page.keyboard.press("End")
    await expect(first).not_to_be_focused()
    await expect(tree.locator("[tabindex='0']")).to_have_count(1)
    await page.keyboard.press("Tab")
    await expect(tree.locator(":focus")).to_have_count(0)


async def assert_fits_and_is_accessible(page: Page) -> None:
    assert await page.evaluate(NO_OVERFLOW)
    assert await page.evaluate(SMALL_TARGETS) == []


@pytest.mark.nightly
async def test_a_maintainer_watches_a_driving_robot_holds_the_view_filters_and_takes_the_run_away(
    tunnel, daemon, visit, tmp_path: Path
):
    mira = await visit("mira.klein", at=tunnel)
    await give_roles(tunnel, mira.email, Role.MAINTAINER, Role.DISPATCHER)
    await mira.order("bob.martin@campus.example")
    page = mira.page
    await page.goto("/robots.html")
    await page.get_by_role("link", name=re.compile("Robot r1")).click()
    intends, feels, believes, trace = (
        page.get_by_role("region", name=name, exact=False)
        for name in ("Intentions", "Sensors", "Beliefs", "Activity log")
    )
    await expect(intends.get_by_text("+!go_to(post1)", exact=True)).to_be_visible()
    await expect(intends.get_by_text(re.compile(r"waits for action follow_line\."))).to_be_visible()
    await expect(feels.get_by_text("following the line")).to_be_visible()
    await intends.get_by_role("treeitem").filter(has_text="+!go_to(post1)").get_by_text("Why this plan").last.click()
    await expect(intends.get_by_text(re.compile(r"^at\(post1\) does not hold"))).to_be_visible()
    await expect(believes.get_by_text(re.compile(r"added:")).first).to_be_attached()
    await mira.assert_accessible()

    await page.get_by_role("button", name="Pause updates").click()
    await walks_the_tree(page)
    newest = await trace.get_by_role("listitem").first.inner_text()
    await expect(page.get_by_text(re.compile(r"Paused; [2-9]\d* new reports"))).to_be_visible()
    assert await trace.get_by_role("listitem").first.inner_text() == newest
    await trace.get_by_label("Filter log").fill("LINE(")
    await expect(trace.get_by_text(re.compile(r"^\d+ of \d+ entries"))).to_be_visible()
    texts = await trace.get_by_role("listitem").all_inner_texts()
    assert texts
    assert all("line(" in text for text in texts)
    await trace.get_by_label("Type", exact=True).select_option("forgot")
    assert all("forgot" in text for text in await trace.get_by_role("listitem").all_inner_texts())
    await page.get_by_role("button", name="Resume updates").click()
    await expect(page.get_by_text("Live from the robot")).to_be_visible()

    async with page.expect_download() as downloading:
        await page.get_by_role("button", name="Download log").click()
    download = await downloading.value
    assert re.fullmatch(r"r1-[0-9T-]+\.jsonl", download.suggested_filename)
    await download.save_as(tmp_path / "run.jsonl")
    head, first, *later = map(json.loads, (tmp_path / "run.jsonl").read_text().splitlines())
    assert (head["campus_mail_watched_run"], head["robot"], head["insights"]) == (1, "r1", len(later) + 1)
    assert first["insight"]["whole"]
    assert len(first["insight"]["came"]) > 20
    numbers = [one["insight"]["number"] for one in later]
    assert numbers == list(range(2, len(later) + 2)), "while it was held still, too"

    await page.get_by_role("button", name="Stop", exact=True).click()
    await page.get_by_role("dialog").get_by_role("button", name=re.compile("top")).click()
    told = page.get_by_role("region", name="Now").get_by_role("listitem").filter(has_text="Emergency stop")
    await expect(told).to_contain_text("done")
    await expect(feels.get_by_text("emergency stop")).to_be_visible()
    await page.get_by_role("button", name="Create one-time code").click()
    await expect(page.get_by_text("Enter this on robot r1. It is shown only once.")).to_be_visible()
    await page.emulate_media(color_scheme="dark")
    await mira.assert_accessible()


@pytest.mark.nightly
async def test_on_a_small_phone_in_french_and_for_a_dispatcher_without_the_mind(tunnel, daemon, visit):
    small = {"viewport": {"width": 320, "height": 640}, "locale": "fr-CA"}
    marc = await visit("marc.roy", on="phone", at=tunnel, color_scheme="dark", **small)
    await give_roles(tunnel, marc.email, Role.MAINTAINER)
    await marc.page.goto("/robots.html?robot=r1")
    await expect(marc.page.get_by_role("heading", name="Croyances")).to_be_visible()
    await expect(marc.page.get_by_role("img", name=re.compile("^De "))).to_be_visible()
    await expect(marc.page.get_by_role("button", name="Pause", exact=True)).to_have_count(0)
    await marc.page.get_by_text(re.compile("^Tout afficher \\(")).click()
    await assert_fits_and_is_accessible(marc.page)
    await marc.assert_accessible()
    await give_roles(tunnel, marc.email, Role.DISPATCHER)
    await marc.page.reload()
    await expect(marc.page.get_by_role("button", name="Pause", exact=True)).to_be_visible()
    await expect(marc.page.get_by_text(re.compile("^Les responsables techniques voient ici"))).to_be_visible()
    await expect(marc.page.get_by_role("heading", name="Croyances")).to_have_count(0)
    await marc.page.goto("/robots.html")
    await expect(marc.page.get_by_role("link", name=re.compile("Le robot r1"))).to_be_visible()
    quality = marc.page.get_by_role("region", name="Exactitude des heures d’arrivée")
    await expect(quality).to_contain_text("Aucune livraison à comparer")
    await expect(quality).to_contain_text("sur les distances de la carte")
    await assert_fits_and_is_accessible(marc.page)
    await marc.assert_accessible()


WATCH_LONG = """async () => {
  const { DiagnosticsRun } = await import("/src/robots/diagnostics_run.js");
  const run = new DiagnosticsRun("r1");
  const at = "2026-01-05T09:00:00Z";
  const empty = { at, cycle: 1, loops: [], intentions: [], events: [], came: [], went: [], trace: [] };
  const nothing = { ...empty, whole: false, left_out: { trace: 0 } };
  const tell = (number, more) => run.take({ robot: "r1", at, insight: { ...nothing, number, ...more } });
  const states = [run.isIncomplete];
  tell(1, { whole: true, came: ["b", "a"] });
  states.push(run.isIncomplete);
  tell(2, { went: ["b"], came: ["c"] });
  tell(5, { trace: Array(2500).fill({ cycle: 1, kind: "did", text: "x" }), left_out: { trace: 7 } });
  states.push(run.isIncomplete);
  const { beliefs, changes, lines, missed, left_out } = run.seen;
  for (let number = 6; number < 7300; number += 1) tell(number, {});
  const [head, ...rest] = run.asJsonLines().trim().split("\\n").map(JSON.parse);
  tell(1, { whole: true, came: ["d"] });
  return {
    states: [...states, run.isIncomplete], beliefs, lines: lines.length, missed, left_out, head, rest: rest.length,
    changes: changes.map(({ came, text }) => (came ? "+" : "-") + text), after: run.seen.beliefs,
  };
}"""
CHARGED = """async () => {
  const { charges, curve, some } = await import("/src/robots/battery_facts.js");
  const at = (minute) => new Date(Date.UTC(2026, 0, 5, 9, minute)).toISOString();
  const sample = (minute, ratio, charging = false) => ({ at: at(minute), ratio, charging });
  const samples = [sample(0, 0.4), sample(1, 0.3, true), sample(2, 0.5, true), sample(3, 0.6)];
  samples.push(sample(40, 0.2, true), sample(41, 0.3, true));
  const history = { robot: "r1", since: at(0), until: at(60), low_ratio: 0.25, samples };
  const times = charges(history).map(({ from_ratio, to_ratio }) => [from_ratio, to_ratio]);
  return { times, pieces: curve(history).split("M").length - 1, some: some([...Array(100).keys()], 5).length };
}"""


@pytest.mark.slow
async def test_what_was_watched_is_bounded_and_what_is_missing_is_known(tunnel, visit):
    ada = await visit("ada.king", at=tunnel)
    await ada.page.goto("/robots.html")
    told = await ada.page.evaluate(WATCH_LONG)
    assert told["states"] == [True, False, True, False], "nothing told yet, all told, some missing, all told again"
    assert (told["beliefs"], told["changes"], told["after"]) == (["a", "c"], ["+c", "-b"], ["d"])
    assert (told["lines"], told["missed"], told["left_out"]) == (2000, 2, 7)
    assert told["head"] == {"campus_mail_watched_run": 1, "robot": "r1", "insights": 7200, "dropped": 97}
    assert told["rest"] == 7200
    charged = await ada.page.evaluate(CHARGED)
    assert charged == {"times": [[0.3, 0.6], [0.2, 0.3]], "pieces": 2, "some": 5}, "a silence is no line"


@pytest.mark.slow
async def test_a_person_who_lacks_the_role_is_told_so(tunnel, visit):
    ada = await visit("ada.king", at=tunnel)
    await ada.page.goto("/robots.html?robot=r1")
    await expect(ada.page.get_by_role("heading", name="You don’t have access to this page")).to_be_visible()
    watch = await ada.context.request.post("/api/v1/robots/r1/watch", headers={"Sec-Fetch-Site": "same-origin"})
    assert watch.status == 403
