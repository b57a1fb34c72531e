"""Two people and a robot: a letter from the form to the hand, seen on both people's pages as it happens."""

import re
from collections.abc import AsyncIterator, Iterator, Sequence
from hashlib import sha256

import pytest
import pytest_asyncio
from playwright.async_api import Page, Route, expect

from protocol.parts import Activity, Battery, Position, StopAction
from protocol.to_robot import Cancel, Confirm, Mission, Verifiers
from protocol.to_server import CommandAnswer, Event, Snapshot, Step, Why
from tests.app.robots.playing import PlayedRobot
from tests.web.camera import Camera
from tests.web.drawn import expect_drawn
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser


class Demonstration:
    """A service with one robot, played by the test, and a camera to hold codes to."""

    def __init__(self, service: Service, robot: PlayedRobot, camera: Camera) -> None:
        self.service, self.robot, self.camera = service, robot, camera
        self.title = f"Robot {robot.name}"

    async def is_given_a_mission(self) -> Mission:
        verifiers = (await self.robot.hear("verifiers")).body
        assert isinstance(verifiers, Verifiers)
        self._expected = {one.sha256 for one in verifiers.verifiers}
        self.mission = await self.robot.mission()
        await self.robot.report(self.mission, Step.ACCEPTED)
        return self.mission

    async def reports(self, step: Step, action: StopAction) -> None:
        (stop,) = [stop for stop in self.mission.stops if stop.action is action]
        await self.robot.ends(await self.robot.report(self.mission, step, stop))

    async def is_seen(self, post: str, towards: str | None) -> None:
        position = Position(post=post, towards=towards, seen_at=self.robot.clock.utc())
        activity = Activity.DRIVING if towards else Activity.WAITING
        await self.robot.say(Snapshot(position=position, activity=activity, battery=Battery(ratio=0.82)))

    async def says(self, sentence: str) -> None:
        await self.robot.say(Why(sentence=sentence))

    async def agrees_to_cancel(self) -> None:
        cancel = (await self.robot.hear("cancel")).body
        assert isinstance(cancel, Cancel)
        now = self.robot.clock.utc()
        answer = CommandAnswer(command_id=cancel.command_id, accepted=True, happened_at=now)
        await self.robot.ends(await self.robot.say(Event(happened=answer)))

    async def checks_the_code_and_hands_over(self, action: StopAction) -> None:
        code = await self.camera.sees()
        assert sha256(code.encode("ascii")).hexdigest() in self._expected
        await self.hands_over(action)

    async def hands_over(self, action: StopAction, **how: str) -> None:
        (stop,) = [stop for stop in self.mission.stops if stop.action is action]
        await self.robot.ends(await self.robot.say(self.robot.receipt(stop, **how)))

    async def hands_over_as_asked(self, action: StopAction) -> None:
        confirm = (await self.robot.hear("confirm")).body
        assert isinstance(confirm, Confirm)
        await self.hands_over(action, how=confirm.how, command_id=confirm.command_id, code_sha256=confirm.by)


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def camera() -> AsyncIterator[Camera]:
    async with Camera().watching() as camera:
        yield camera


@pytest.fixture(scope="module")
def demo_service(tmp_path_factory: pytest.TempPathFactory, camera: Camera) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("demo"), door=camera.door) as service:
        yield service


@pytest_asyncio.fixture(loop_scope="session")
async def demonstration(
    demo_service: Service, camera: Camera, request: pytest.FixtureRequest
) -> AsyncIterator[Demonstration]:
    """Each test has a robot of its own, the only one that is connected."""
    name = f"r{len(request.node.name)}"
    async with demo_service.connected(name, understands=("confirm",)) as robot:
        yield Demonstration(demo_service, robot, camera)


async def follow_what_is_told(page: Page, title: str) -> None:
    """On whatever page one is."""
    await page.get_by_role("status").get_by_role("link", name=re.compile(title)).click()


async def is_told(person: Visitor, titles: Sequence[str]) -> None:
    """Each once among the notices, and the same by mail."""
    page = person.page
    await page.get_by_role("link", name=re.compile("Inbox")).click()
    await expect(page.get_by_role("heading", level=1)).to_have_text("Notifications")
    await expect(page.locator(".notices li")).to_have_count(len(titles))
    for title in titles:
        await expect(page.get_by_role("link", name=re.compile(title))).to_have_count(1)
    mailed = person.service.subjects_mailed_to(person.email, len(titles))
    # A mail says its time in whole seconds: of one second, any order is what a mail program may show.
    order_of = [(at, next(n for n, title in enumerate(titles) if re.search(title, subject))) for at, subject in mailed]
    assert [n for _, n in sorted(order_of)] == list(range(len(titles)))


@pytest.mark.slow
async def test_two_people_and_a_robot_ordered_loaded_by_code_followed_received_by_code_and_both_told(
    demonstration, visit
):
    robot = demonstration.title
    ada = await visit("ada.king", on="phone", at=demonstration.service)
    bob = await visit("bob.martin", on="desk", at=demonstration.service, color_scheme="dark")
    await bob.page.goto("/")
    await expect(bob.page.get_by_role("heading", name="Send a letter")).to_be_visible()

    await ada.page.goto("/")
    await ada.page.get_by_label("From").select_option("Post 1")
    await ada.page.get_by_label("To", exact=True).select_option("Post 4")
    await ada.page.get_by_label("Recipient’s email").fill(bob.email)
    await ada.page.get_by_label("Contents").fill("Signed forms")
    await ada.page.get_by_role("button", name="Send the robot").click()
    standing = ada.page.get_by_role("heading", level=1)
    await demonstration.is_given_a_mission()
    await expect(standing).to_have_text(f"{robot} will collect your letter")

    await demonstration.reports(Step.DEPARTED, StopAction.LOAD)
    await expect(standing).to_have_text(f"{robot} is coming to Post 1")
    await demonstration.is_seen("post3", towards="post2")
    await demonstration.says("Driving towards post2")
    facts = ada.page.get_by_role("region", name="Robot location").get_by_role("list")
    await expect(facts.get_by_text(re.compile("^Last seen at Post 3, "))).to_be_visible()
    await expect(facts.get_by_text(re.compile("^Expected at Post 4, "))).to_be_visible()
    await expect(facts.get_by_text("Driving towards Post 2")).to_be_visible()
    await expect(facts.get_by_text("Battery 82%")).to_be_visible()
    await expect(ada.page.get_by_role("region", name="Why it is waiting")).to_be_hidden()
    await expect(ada.page.get_by_role("img", name="Map: The paper's test track")).to_contain_text("last seen")

    await demonstration.reports(Step.ARRIVED, StopAction.LOAD)
    await demonstration.is_seen("post1", towards=None)
    await demonstration.says("waiting for the sender to load")
    await expect(standing).to_have_text(f"{robot} is waiting for you at Post 1")
    await expect(ada.page.get_by_role("region", name="Why it is waiting")).to_contain_text(
        "waiting for the sender to load"
    )
    code = ada.page.get_by_role("region", name="Your code to load the robot")
    await expect(code.get_by_role("img", name="QR code for the robot’s camera")).to_be_visible()
    await expect_drawn(code.get_by_role("img"))
    await ada.assert_accessible()
    await code.get_by_role("button", name="Hold the code to the robot’s camera (simulated)").click()
    await demonstration.checks_the_code_and_hands_over(StopAction.LOAD)
    await expect(standing).to_have_text("Your letter is on its way to Post 4")
    await expect(standing).to_be_in_viewport(ratio=1)
    await expect(code).to_be_hidden()
    await expect(ada.page.get_by_role("button", name="Cancel this order")).to_be_hidden()
    await expect(ada.page.get_by_role("button", name="Request a return")).to_be_visible()

    await follow_what_is_told(bob.page, "is on its way to you")
    standing_for_bob = bob.page.get_by_role("heading", level=1)
    await expect(standing_for_bob).to_have_text("A letter is on its way to you")
    code_of_bob = bob.page.get_by_role("region", name="Your code to take the letter")
    await expect(code_of_bob.get_by_role("img")).to_be_hidden()
    await expect(code_of_bob.locator("img")).to_have_js_property("complete", True)
    async with bob.without_network():  # as in the tunnel
        await code_of_bob.get_by_text("Show the code").click()
        await expect(code_of_bob.get_by_role("img")).to_be_visible()
        await expect_drawn(code_of_bob.get_by_role("img"))
    await bob.assert_accessible()

    await demonstration.reports(Step.DEPARTED, StopAction.RECEIVE)
    await demonstration.reports(Step.ARRIVED, StopAction.RECEIVE)
    await expect(standing).to_have_text(f"{robot} is waiting for Bob Martin {name_suffix(bob)} at Post 4")
    await expect(standing_for_bob).to_have_text(f"{robot} is waiting for you at Post 4")
    await code_of_bob.get_by_role("button", name=re.compile("^Hold the code")).click()
    await demonstration.checks_the_code_and_hands_over(StopAction.RECEIVE)

    for page in (ada.page, bob.page):
        await expect(page.get_by_role("heading", level=1)).to_have_text("Delivered")
        timeline = page.get_by_role("region", name="Progress").get_by_role("listitem")
        await expect(timeline).to_have_count(7)
        await expect(timeline.last).to_contain_text(re.compile("Taken by Bob Martin .*, confirmed"))
        hands = page.get_by_role("region", name="Chain of custody").get_by_role("listitem")
        await expect(hands).to_contain_text(
            [re.compile("Ada King"), re.compile("with the code of Ada"), re.compile("with the code of Bob")]
        )
    await is_told(ada, ("Order accepted", "near Post 1", "waiting at Post 1", "Delivered"))
    await is_told(bob, ("is on its way to you", "waiting for you at Post 4", "Delivered"))


def name_suffix(visitor):
    """Visitors are told apart by a number, which their name shows."""
    return re.search(r"\.(n\d+)@", visitor.email)[1].capitalize()


@pytest.mark.slow
async def test_a_robot_out_of_reach_is_said_to_be_so_and_its_order_goes_on(demonstration, visit):
    robot = demonstration.title
    ada = await visit("ada.king", at=demonstration.service)
    order_id = await ada.order("bob.martin@campus.example")
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.DEPARTED, StopAction.LOAD)
    await ada.page.goto(f"/follow.html?order={order_id}")
    await expect(ada.page.get_by_role("heading", level=1)).to_have_text(f"{robot} is coming to Post 1")
    await demonstration.robot.socket.close()
    await expect(ada.page.get_by_text(re.compile("^Offline. Last contact .* it continues on its own"))).to_be_visible()
    await expect(ada.page.get_by_role("heading", level=1)).to_have_text(f"{robot} is coming to Post 1")


@pytest.mark.nightly
async def test_why_it_waits_is_said_in_french_and_what_has_no_french_is_marked(demonstration, visit):
    ada = await visit("ada.king", at=demonstration.service, locale="fr-CA")
    order_id = await ada.order("bob.martin@campus.example")
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.DEPARTED, StopAction.LOAD)
    await ada.page.goto(f"/follow.html?order={order_id}")
    await demonstration.is_seen("post3", towards="post2")
    await demonstration.says("Driving towards post2")
    await expect(ada.page.get_by_text("En route vers Post 2")).to_be_visible()
    await demonstration.says("Juggling at post2")
    await expect(ada.page.get_by_text("« Juggling at post2 » (en anglais)")).to_be_visible()


async def test_an_answer_that_is_overtaken_does_not_undo_what_was_heard(demonstration, visit):
    """The first answer is lost, so that all is asked anew once the stream stands; then several answers in a row are
    read by the service before the robot is heard, and reach the page after that."""
    ada = await visit("ada.king", at=demonstration.service)
    order_id = await ada.order("bob.martin@campus.example")
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.DEPARTED, StopAction.LOAD)
    ada.loses_answers = True
    posts = iter(("", "post5", "post3", "post2"))

    async def be_overtaken(route: Route) -> None:
        answer, post = await route.fetch(), next(posts, None)
        if post:
            async with ada.page.expect_event("console", lambda said: said.text == "robot heard"):
                await demonstration.is_seen(post, towards="post1")
        await (route.abort() if post == "" else route.fulfill(response=answer))

    await ada.page.add_init_script(
        """const Real = EventSource;
        window.EventSource = class extends Real {
          constructor(url) {
            super(url);
            this.addEventListener("robot", () => setTimeout(() => console.log("robot heard")));
          }
        };"""
    )
    await ada.page.route(f"**/api/v1/orders/{order_id}", be_overtaken)
    await ada.page.goto(f"/follow.html?order={order_id}")
    facts = ada.page.get_by_role("region", name="Robot location").get_by_role("list")
    await expect(facts.get_by_text(re.compile("^Last seen at Post 2, "))).to_be_visible()
    assert next(posts, None) is None
    await ada.page.wait_for_timeout(500)  # whatever is still on its way has come by then
    await expect(facts.get_by_text(re.compile("^Last seen at Post 2, "))).to_be_visible()
    await ada.page.unroute_all(behavior="wait")


async def test_cancelling_with_a_robot_on_its_way_waits_for_the_robots_answer(demonstration, visit):
    ada = await visit("ada.king", at=demonstration.service)
    order_id = await ada.order("bob.martin@campus.example")
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.DEPARTED, StopAction.LOAD)
    await ada.page.goto(f"/follow.html?order={order_id}")
    await ada.page.get_by_role("button", name="Cancel this order").click()
    await ada.page.get_by_role("button", name="Yes, cancel it").click()
    await expect(ada.page.get_by_text("The robot has been asked to turn back.")).to_be_visible()
    await expect(ada.page.get_by_role("button", name="Cancel this order")).to_be_hidden()
    await demonstration.agrees_to_cancel()
    await expect(ada.page.get_by_role("heading", level=1)).to_have_text("Cancelled")


@pytest.mark.slow
async def test_a_delegate_digits_a_longer_wait_and_not_now(demonstration, visit):
    ada = await visit("ada.king", at=demonstration.service)
    bob = await visit("bob.martin", on="phone", at=demonstration.service)
    order_id = await ada.order(bob.email)
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.ARRIVED, StopAction.LOAD)
    for page in (ada.page, bob.page):
        await page.goto(f"/follow.html?order={order_id}")
    await ada.page.get_by_text("Let another person meet the robot").click()
    await ada.page.get_by_label("Their name").fill("The porter")
    await ada.page.keyboard.press("Enter")
    await expect(ada.page.get_by_role("img", name="Code for The porter")).to_be_visible()
    porter = ada.page.get_by_role("listitem").filter(has_text="share the code yourself")
    await ada.assert_accessible()
    await porter.get_by_role("button", name="Revoke, The porter").click()
    await expect(ada.page.get_by_role("img", name="Code for The porter")).to_be_hidden()
    waiting = ada.page.get_by_role("region", name="The robot is waiting")
    until = await waiting.get_by_role("status").inner_text()
    await waiting.get_by_role("button", name="5 more minutes").click()
    await expect(waiting.get_by_role("status")).not_to_have_text(until)

    digits = await ada.page.get_by_role("region", name="Your code to load the robot").locator("strong").inner_text()
    await bob.page.get_by_text("Enter six digits instead").click()
    await bob.page.get_by_label("Six digits").fill("12 34")
    await bob.page.keyboard.press("Enter")
    await expect(bob.page.get_by_label("Six digits")).to_have_accessible_description(re.compile("Enter all six digits"))
    await bob.page.get_by_label("Six digits").fill(digits)
    await bob.page.keyboard.press("Enter")
    await demonstration.hands_over_as_asked(StopAction.LOAD)
    await expect(bob.page.get_by_role("heading", level=1)).to_have_text("A letter is on its way to you")
    hands = bob.page.get_by_role("region", name="Chain of custody").get_by_role("listitem")
    await expect(hands.nth(1)).to_contain_text("confirmed with the digits of Ada King")
    await bob.page.get_by_role("button", name="I can’t take it now").click()
    await bob.page.get_by_role("button", name="Yes, send it back").click()
    for page in (ada.page, bob.page):
        await expect(page.get_by_text("The robot has been asked to bring it back.")).to_be_visible()
    await bob.assert_accessible()


@pytest.mark.nightly
async def test_a_recipient_without_account_takes_the_letter_by_the_link_in_the_mail(demonstration, visit):
    ada = await visit("ada.king", at=demonstration.service)
    guest = await visit("grace.hill", on="phone", at=demonstration.service, signed_in=False)
    await ada.order(guest.email)
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.ARRIVED, StopAction.LOAD)
    await demonstration.hands_over(StopAction.LOAD)
    await guest.page.goto(demonstration.service.link_mailed_to(guest.email))
    standing = guest.page.get_by_role("heading", level=1)
    await expect(standing).to_have_text("A letter is on its way to you")
    code = guest.page.get_by_role("region", name="Your code to take the letter")
    await code.get_by_text("Show the code").click()
    await expect_drawn(code.get_by_role("img"))

    await demonstration.is_seen("post4", towards=None)
    await demonstration.reports(Step.ARRIVED, StopAction.RECEIVE)
    await expect(standing).to_have_text(f"{demonstration.title} is waiting for you at Post 4")
    await guest.page.get_by_role("button", name="Français").click()
    await expect(standing).to_contain_text("vous attend à Post 4")
    async with guest.without_network():
        said = re.compile("^Pas de réseau.*Votre code fonctionne quand même")
        await expect(guest.page.get_by_text(said)).to_be_visible()
    await guest.page.get_by_role("button", name="English").click()
    await guest.page.get_by_text("Let another person meet the robot").click()
    await guest.page.get_by_label("Their name").fill("The porter")
    await guest.page.keyboard.press("Enter")
    await expect(guest.page.get_by_role("img", name="Code for The porter")).to_be_visible()
    await guest.assert_accessible()
    await code.get_by_role("button", name="Without the camera: I’m taking it out now").click()
    await expect(code.get_by_text("Waiting for the robot to confirm.")).to_be_visible()
    await demonstration.hands_over_as_asked(StopAction.RECEIVE)
    await expect(standing).to_have_text("Delivered")
    await expect(standing).to_be_in_viewport(ratio=1)


@pytest.mark.slow
async def test_a_delegate_sees_by_the_link_in_their_mail_where_it_is_and_their_code_and_no_more(demonstration, visit):
    ada = await visit("ada.king", at=demonstration.service)
    porter = await visit("grace.hill", on="phone", at=demonstration.service, signed_in=False)
    order_id = await ada.order("bob.martin@campus.example")
    await ada.name_delegate(order_id, porter.email)
    await demonstration.is_given_a_mission()
    await demonstration.reports(Step.ARRIVED, StopAction.LOAD)
    await porter.page.goto(demonstration.service.link_mailed_to(porter.email))
    standing = porter.page.get_by_role("heading", level=1)
    await expect(standing).to_have_text(f"{demonstration.title} is waiting at Post 1")
    code = porter.page.get_by_role("region", name="Your code to load the robot")
    await expect_drawn(code.get_by_role("img"))
    await expect(porter.page.get_by_text("Ada King")).to_be_visible()
    await expect(porter.page.get_by_text("ada.king@")).to_have_count(0)
    await expect(porter.page.get_by_role("heading", name="Progress")).to_have_count(0)
    await porter.assert_accessible()
    await code.get_by_role("button", name=re.compile("^Without the camera")).click()
    await expect(code.get_by_text("Waiting for the robot to confirm.")).to_be_visible()
    await demonstration.hands_over_as_asked(StopAction.LOAD)
    await expect(standing).to_have_text("The letter is on its way to Post 4")
    await expect(code).to_be_hidden()


async def test_a_link_that_opens_nothing_says_so(visit):
    guest = await visit("grace.hill", on="phone", signed_in=False)
    guest.refusals_expected.add("/api/v1/link/order")
    await guest.page.goto("/one-order.html#" + "x" * 43)
    await expect(guest.page.get_by_role("heading", level=1)).to_have_text("This link no longer works")
    await guest.assert_accessible()
