"""A dispatcher sees on one screen what is wrong and mends it, with the keyboard alone; and what the mailroom prints."""

import csv
import io
import re
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
import pytest_asyncio
from playwright.async_api import expect

from protocol.parts import StopAction
from protocol.to_robot import EmergencyStop, Pause
from protocol.to_server import Event, Fault, Step, Why
from tests.web.drawn import expect_drawn
from tests.web.keyboard import press
from tests.web.mailroom_scene import Campus
from tests.web.service import Service

pytestmark = pytest.mark.browser

MAILROOM = "/mailroom.html"
SHEET_MM = """() => [...document.querySelectorAll(".marker-sheet")].map((sheet) => {
  const {width, height} = sheet.getBoundingClientRect();
  return [width, height].map((px) => Math.round(px * 254 / 96) / 10).join(" × ");
})"""


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def busy_campus(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Campus]:
    """Twelve orders, four robots, and something wrong of each kind."""
    with Service(tmp_path_factory.mktemp("busy")) as service:
        campus = Campus(service)
        campus.orders = await campus.scene.is_busy()
        await campus.scene.everything_goes_wrong(campus.orders)
        yield campus


@pytest.mark.nightly
async def test_what_goes_wrong_appears_by_itself_and_is_mended_by_keyboard_alone(quiet_campus, robot, visit):
    dana = await quiet_campus.dispatcher(visit)
    ada = await visit("ada.king", at=quiet_campus.service)
    page = dana.page
    await page.goto(MAILROOM)
    wrong = page.get_by_role("region", name="Issues")
    await expect(wrong).to_contain_text("No issues")
    await expect(page.get_by_text("Nothing in progress.")).to_be_visible()

    order_id = await ada.order("bob.martin@campus.example", what="Signed forms")
    mission = await robot.mission()
    stops = {stop.action: stop for stop in mission.stops}
    for step in (Step.ACCEPTED, Step.DEPARTED, Step.ARRIVED):
        await robot.report(mission, step, None if step is Step.ACCEPTED else stops[StopAction.LOAD])
    await robot.ends(await robot.say(robot.receipt(stops[StopAction.LOAD])))
    queue = page.get_by_role("region", name=re.compile("^In progress"))
    await expect(queue.get_by_text("Signed forms")).to_be_visible()
    await expect(queue.get_by_text("On its way").first).to_be_visible()
    fault = Fault(name="cliff", happened_at=robot.clock.utc(), post="post2", reason="It stands before a drop.")
    await robot.ends(await robot.say(Event(happened=fault)))

    await expect(wrong.get_by_text(f"Robot {robot.name}, Post 2", exact=True)).to_be_visible()
    await expect(wrong.get_by_text("Post 1 → Post 4 is stuck", exact=True)).to_be_visible()
    await press(page, "Acknowledge")
    await expect(wrong.get_by_text(f"Robot {robot.name}, Post 2", exact=True)).to_be_hidden()
    await expect(page.get_by_text("Acknowledged: The robot stands before a drop.")).to_be_visible()
    await expect(page.get_by_role("heading", name=re.compile("^Issues"))).to_be_focused()

    await press(page, "Decide")
    dialog = page.get_by_role("dialog", name=re.compile("^Decide about the mail from Ada King"))
    await expect(dialog.get_by_role("radio", name="Continue as before")).to_be_focused()
    await dana.assert_accessible()
    await page.keyboard.press("Escape")
    await expect(page.get_by_role("button", name=re.compile("^Decide"))).to_be_focused()
    await page.keyboard.press("Enter")
    await expect(dialog.get_by_role("radio", name="Continue as before")).to_be_focused()
    await page.keyboard.press("ArrowDown")
    await page.keyboard.press("Enter")  # "Return it"
    await expect(wrong).to_contain_text("No issues")
    assert (await dana.api(f"/orders/{order_id}"))["state"] == "returning"
    await expect(queue.get_by_text("Being brought back")).to_be_visible()


@pytest.mark.slow
async def test_a_robot_is_paused_let_go_on_and_stopped_by_keyboard_alone(quiet_campus, robot, visit):
    dana = await quiet_campus.dispatcher(visit)
    page = dana.page
    await page.goto(MAILROOM)
    await press(page, rf"Pause\W+{robot.name}")
    await expect(page.get_by_label("Reason")).to_be_focused()
    await page.keyboard.press("Enter")
    await expect(page.get_by_text("Enter a reason")).to_be_visible()
    await expect(page.get_by_label("Reason")).to_be_focused()
    await page.keyboard.type("A parade")
    await page.keyboard.press("Enter")
    heard = (await robot.hear("pause")).body
    assert isinstance(heard, Pause)
    assert heard.reason == "A parade"
    await expect(page.get_by_role("status").get_by_text(f"Pause sent to robot {robot.name}.")).to_be_visible()
    await robot.say(Why(sentence="Paused"))
    await expect(
        page.get_by_role("region", name="Issues").get_by_text(f"Robot {robot.name} has stopped")
    ).to_be_visible()
    await page.get_by_role("button", name=re.compile("^Resume")).first.focus()
    await page.keyboard.press("Enter")
    await page.keyboard.press("Enter")
    await robot.hear("resume")
    await robot.say(Why(sentence="Nothing to do"))
    await expect(page.get_by_text(f"Robot {robot.name} has stopped")).to_be_hidden()

    await press(page, rf"Stop\W+{robot.name}")
    await expect(page.get_by_role("button", name=f"Stop {robot.name} now")).to_be_focused()
    await page.keyboard.press("Enter")  # one key says yes
    heard = (await robot.hear("emergency_stop")).body
    assert isinstance(heard, EmergencyStop)
    assert heard.reason == "Stopped from the mailroom"


@pytest.mark.slow
async def test_an_order_for_a_person_at_the_desk_is_placed_by_keyboard_and_printed(quiet_campus, visit):
    grace = await visit("grace.hill", at=quiet_campus.service)
    bob = await visit("bob.martin", at=quiet_campus.service)
    dana = await quiet_campus.dispatcher(visit)
    dana.refusals_expected.add("/api/v1/orders")
    page = dana.page
    await page.goto(MAILROOM)
    await press(page, "Order at the desk")
    sender = page.get_by_role("combobox", name="Sender")
    await expect(sender).to_be_focused()
    await page.keyboard.type("grace")
    option = page.get_by_role("option", name=re.compile(f"Grace Hill .*{grace.email}"))
    await expect(option).to_be_visible()
    await page.keyboard.press("Escape")  # closes the list, not the dialog
    await expect(option).to_be_hidden()
    await page.keyboard.press("ArrowDown")
    await expect(option).to_have_attribute("aria-selected", "true")
    await dana.assert_accessible()
    await page.keyboard.press("Enter")
    await expect(sender).to_have_value(grace.email)
    await page.keyboard.press("Tab")
    await page.keyboard.type(bob.email)
    await page.keyboard.press("Tab")
    await page.keyboard.type("Post 2")
    await page.keyboard.press("Tab")
    await page.keyboard.type("Post 2")
    await press(page, "Place order")
    await expect(page.get_by_text("Choose two different posts")).to_be_visible()
    await expect(page.get_by_label("To", exact=True)).to_be_focused()
    await page.keyboard.type("Post 4")
    await press(page, "Place order")
    await expect(page.get_by_role("heading", name="Ordered")).to_be_focused()
    await page.get_by_role("link", name="Print slip").focus()
    await page.keyboard.press("Enter")
    slip = page.get_by_role("article", name="Mail slip")
    for words in ("Grace Hill", "Bob Martin", "Post 2", "Post 4", "follow.html", "is notified when one comes"):
        await expect(slip).to_contain_text(words)
    await expect(page.get_by_text(re.compile("^No robot is assigned yet. Its code is added"))).to_be_visible()
    for_phones = slip.get_by_role("img", name="QR code of the order page")
    await expect_drawn(for_phones)
    order_id = page.url.partition("order=")[2]
    order = await dana.api(f"/orders/{order_id}")
    assert (order["sender"]["email"], order["recipient"]["email"]) == (grace.email, bob.email)
    assert order["placed_by"]["email"] == dana.email
    await dana.assert_accessible()
    await page.emulate_media(media="print")
    await expect(page.get_by_role("navigation")).to_be_hidden()
    await expect(page.get_by_role("button", name="Print")).to_be_hidden()
    await expect(slip).to_be_visible()

    async with quiet_campus.service.connected("walk-up"):
        await expect(slip.get_by_role("img", name="QR code for the robot’s camera")).to_be_visible()
        await expect(for_phones).to_be_hidden()


@pytest.mark.slow
async def test_everything_that_is_wrong_has_its_next_action(busy_campus, visit, tmp_path: Path):
    dana = await busy_campus.dispatcher(visit)
    page = dana.page
    await page.goto(MAILROOM)
    wrong = page.get_by_role("region", name="Issues").get_by_role("listitem")
    await expect(wrong).to_have_count(6)
    actions = ("Acknowledge", "Decide", "Unlock digits", "Resume", "View", "Try again")
    for row, action in zip(await wrong.all(), actions, strict=True):
        await expect(
            row.get_by_role("link" if action == "View" else "button", name=re.compile(f"^{action}"))
        ).to_be_visible()
    assert await page.evaluate("litHtmlVersions.length") == 1, "directives have the same Lit as all else"
    await press(page, "Unlock digits")
    await page.keyboard.press("Enter")
    await expect(wrong).to_have_count(5)

    queue = page.get_by_role("region", name=re.compile("^In progress"))
    rows = queue.get_by_role("listitem")
    await expect(rows).to_have_count(12)
    await expect(queue.get_by_text("Scheduled for")).to_be_visible()
    await queue.get_by_label("Sort by").select_option("Priority")
    await expect(rows.last).to_contain_text("Low priority")
    await queue.get_by_label("Search orders").fill("turing")
    await expect(rows).to_have_count(4)
    await rows.filter(has_text="Contract").get_by_role("button", name=re.compile("^Actions")).click()
    await expect(page.get_by_role("dialog").get_by_role("button")).to_have_text(
        [
            *("Extend waiting time", "Change priority", "Reassign", "Cancel the order"),
            *("Stop and decide by hand", "Close"),
        ]
    )
    await page.get_by_role("button", name="Change priority").click()
    await page.get_by_role("radio", name="High priority").check()
    await page.get_by_role("button", name="Save").click()
    await expect(rows.filter(has_text="Contract")).to_contain_text("High priority")

    await press(page, "Unsent mail")
    dialog = page.get_by_role("dialog", name="Unsent mail")
    await dialog.get_by_role("button", name=re.compile("^Your sign-in code.*dana")).first.click()
    mail = page.locator("pre.mail")
    await expect(mail).to_contain_text("[redacted]")
    assert not re.search(r"\b\d{8}\b", await mail.inner_text())
    await page.get_by_role("button", name="Back to the list").click()
    await dialog.get_by_role("button", name=re.compile("^Try again")).first.click()
    await expect(dialog.get_by_text("Sending again to")).to_be_visible()
    await page.keyboard.press("Escape")

    await press(page, "Export")
    async with page.expect_download() as coming:
        await page.keyboard.press("Tab")
        await page.get_by_role("button", name="Download").click()
    table = tmp_path / "orders.csv"
    await (await coming.value).save_as(table)
    lines = list(csv.DictReader(io.StringIO(table.read_text(encoding="utf-8-sig"), newline="")))
    assert {line["id"] for line in lines} == set(busy_campus.orders)


@pytest.mark.nightly
async def test_on_a_phone_each_part_of_the_mailroom_is_a_tap_away_however_far_one_has_come(busy_campus, visit):
    dana = await busy_campus.dispatcher(visit, on="phone")
    page = dana.page
    await page.goto(MAILROOM)
    parts = page.get_by_role("navigation", name="On this page")
    titles = {"Map": "The paper's test track", "In progress": "In progress", "Robots": "Robots", "Issues": "Issues"}
    for part, title in titles.items():
        await parts.get_by_role("link", name=re.compile(f"^{part}")).click()
        heading = page.get_by_role("heading", level=2, name=re.compile(f"^{title}"))
        await expect(heading).to_be_focused()
        await expect(heading).to_be_in_viewport()
        await expect(parts).to_be_in_viewport()
    await page.set_viewport_size({"width": 1280, "height": 860})
    await expect(parts).to_be_hidden()


@pytest.mark.slow
async def test_a_wall_shows_the_campus_at_work_and_no_full_name(busy_campus, visit):
    dana = await busy_campus.dispatcher(visit, viewport={"width": 1920, "height": 1080})
    page = dana.page
    await page.goto(f"{MAILROOM}?wall")
    await expect(page.get_by_role("region", name=re.compile("^In progress"))).to_contain_text("G. Hill to C. Sagan")
    await expect(page.get_by_role("region", name="Robots")).to_contain_text("Charging at Post 5")
    await expect(page.get_by_role("region", name="Map").get_by_role("img").first).to_be_visible()
    await expect(page.get_by_role("time")).to_have_text(re.compile(r"^\d{1,2}:\d\d"))
    text = await page.get_by_role("main").inner_text()
    for secret in ("Grace", "Ada", "Lovelace to Bob", "@campus.example", "blue envelope", "The lid does not close"):
        assert secret not in text
    await expect(page.get_by_role("button")).to_have_count(0)


@pytest.mark.nightly
async def test_marker_sheets_are_printed_in_their_true_size_with_nothing_around_them(busy_campus, visit):
    dana = await busy_campus.dispatcher(visit)
    page = dana.page
    await page.goto("/print.html")
    await expect(page.get_by_role("button", name="Print 9 sheets")).to_be_visible()
    await page.get_by_role("checkbox", name=re.compile("^Post 3")).uncheck()
    await expect(page.get_by_role("button", name="Print 6 sheets")).to_be_visible()
    await page.emulate_media(media="print")
    await expect(page.get_by_role("banner")).to_be_hidden()
    sheets = page.get_by_role("img", name=re.compile("^Marker sheet for"))
    await expect(sheets).to_have_count(6)
    assert await page.evaluate(SHEET_MM) == ["148 × 210"] * 6
    for paper in ("A4", "Letter"):
        pdf = await page.pdf(format=paper)
        assert pdf.count(b"/Type /Page\n") == 6, paper


@pytest.mark.nightly
async def test_others_are_told_whose_page_this_is(quiet_campus, visit):
    ada = await visit("ada.king", at=quiet_campus.service)
    for address in (MAILROOM, "/print.html"):
        await ada.page.goto(address)
        await expect(ada.page.get_by_role("heading", level=1)).to_be_visible()
        await expect(ada.page.get_by_text(re.compile("dispatchers"))).to_be_visible()
        await expect(ada.page.get_by_role("link", name="Mailroom")).to_have_count(0)


@pytest.mark.nightly
async def test_a_long_queue_goes_on_where_the_page_ends(quiet_campus, visit):
    ids = [order_id for _ in range(3) for order_id in await quiet_campus.scene.is_ordered_for_later(35)]
    dana = await quiet_campus.dispatcher(visit)
    await dana.page.goto(MAILROOM)
    rows = dana.page.get_by_role("region", name=re.compile("^In progress")).get_by_role("listitem")
    more = dana.page.get_by_role("button", name="Show more")
    await more.focus()
    before = await rows.count()
    assert before >= 100
    await dana.page.keyboard.press("Enter")
    await expect(more).to_be_hidden()
    assert await rows.count() >= len(ids) > 100
