"""Every page in every state that people come upon: axe-core, contrast, larger letters, small windows, targets.

The functions of `states.py` and `states_of_staff.py` lead through the states; what is measured is in `looking.py`.
"""

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import pytest
import pytest_asyncio
from playwright.async_api import expect

from protocol.diagnostics import Diagnostics
from protocol.example_files import EXAMPLES
from protocol.parts import Activity, Battery, Position
from protocol.to_server import Snapshot, Why
from tests.app.robots.playing import PlayedRobot
from tests.web import states, states_of_staff
from tests.web.full_campus import Campus, full_campus
from tests.web.keyboard import Keyboard
from tests.web.looking import NARROW, Looker
from tests.web.service import Service
from tests.web.states import States, stands
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

INSIGHT = Diagnostics.model_validate(json.loads((EXAMPLES / "insight.json").read_text(encoding="utf-8"))["body"])
AWAY, CONNECTED = "r4", "r9"


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def campus(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Campus]:
    async with full_campus(tmp_path_factory.mktemp("states")) as campus:
        yield campus


@asynccontextmanager
async def a_robot_that_tells(service: Service) -> AsyncIterator[None]:
    """A robot that sends diagnostics as soon as it is watched."""
    async with service.connected(CONNECTED, understands=("confirm", "watch")) as robot:
        for activity in (Activity.CHARGING, Activity.WAITING):
            battery = Battery(ratio=0.5, charging=activity is Activity.CHARGING)
            await robot.say(Snapshot(position=Position(post="post5"), activity=activity, battery=battery))
        await robot.say(Why(sentence="Charging at post5"))
        telling = asyncio.create_task(_tells(robot))
        yield
        telling.cancel()
        with suppress(asyncio.CancelledError):
            await telling


async def _tells(robot: PlayedRobot) -> None:
    while await robot.hear("watch", limit_s=60):
        await robot.say(INSIGHT)


async def look_at_all(person: Visitor, all_states: States) -> None:
    looker = Looker(person)
    async for state in all_states:
        await looker.look(state)
    assert looker.seen
    assert not looker.wrong, "\n".join(looker.wrong)


def name_of(person: Visitor) -> str:
    return person.email.partition("@")[0]


@pytest.mark.slow
async def test_a_person_who_is_not_signed_in(visit, campus):
    ada = await visit(at=campus.service, signed_in=False, reduced_motion="reduce")
    await look_at_all(ada, states.signing_in(ada))


@pytest.mark.parametrize("led", [states.ordering, states.reading_mail, states.reading_notices, states.settling])
@pytest.mark.nightly
async def test_pages_for_everybody(visit, campus, led):
    ada = await visit("ada.king", at=campus.service, reduced_motion="reduce")
    await look_at_all(ada, led(ada))


@pytest.mark.parametrize("led", [states.following, states.at_the_robot])
@pytest.mark.nightly
async def test_a_letter_followed(visit, campus, led):
    ada = await visit("ada.king", at=campus.service, reduced_motion="reduce")
    await look_at_all(ada, led(ada, await campus.order_of(name_of(ada), "bob.martin", "at_sender")))


@pytest.mark.nightly
async def test_one_order_without_account(visit, campus):
    guest = await visit("grace.hopper", at=campus.service, signed_in=False, reduced_motion="reduce")
    await campus.order_of("bob.martin", name_of(guest), "at_recipient")
    await look_at_all(guest, states_of_staff.by_a_link(guest, campus.service.link_mailed_to(guest.email)))


@pytest.mark.parametrize(
    "led", [states_of_staff.dispatching, states_of_staff.working_at_the_desk, states_of_staff.on_a_quiet_day]
)
@pytest.mark.nightly
async def test_the_mailroom(visit, campus, led):
    dana = await campus.staff(visit)
    await look_at_all(dana, led(dana))


@pytest.mark.nightly
async def test_what_is_printed_and_the_wall(visit, campus):
    dana = await campus.staff(visit)
    await look_at_all(dana, states_of_staff.printing(dana, campus.orders[0]))


@pytest.mark.nightly
async def test_the_robots(visit, campus):
    mira = await campus.staff(visit)
    async with a_robot_that_tells(campus.service):
        await look_at_all(mira, states_of_staff.keeping_robots(mira, AWAY, CONNECTED))


CODE_IS_SEEN_AT_ONCE = """() => {
  const bar = document.querySelector(".pages").getBoundingClientRect();
  return scrollY === 0 && document.querySelector(".qr").getBoundingClientRect().bottom <= bar.top;
}"""
EVERY_PAGE: tuple[str, ...] = (
    "/",
    "/mail.html",
    "/notices.html",
    "/settings.html",
    "/follow.html?order={}",
    "/mailroom.html",
)
EVERY_PAGE += (
    "/mailroom.html?wall",
    "/robots.html",
    f"/robots.html?robot={AWAY}",
    "/print.html",
    "/print.html?order={}",
)


@pytest.mark.nightly
async def test_every_page_speaks_french_stands_still_and_lets_a_keyboard_through(visit, campus):
    dana = await campus.staff(visit, locale="fr-CA")
    order_id = await campus.order_of(name_of(dana), "bob.martin", "at_sender")
    page, looker = dana.page, Looker(dana)
    # What one is told meanwhile pops up for a while, over what the keyboard may be at.
    await page.route("**/api/v1/live", lambda route: None)
    for address in EVERY_PAGE:
        await stands(page, address.format(order_id), one_moment="Chargement")
        await looker.look_at_words(address)
        await looker.moving(address)
        await page.set_viewport_size(NARROW)
        if "follow" in address:
            assert await page.evaluate(CODE_IS_SEEN_AT_ONCE), "the code is in view for a person at the robot"
        keys = Keyboard(page)
        await keys.stands()
        stops = await keys.walk()
        assert ("wall" in address) or stops[0] == "Aller au contenu", address
    guest = await visit("grace.hopper", at=campus.service, signed_in=False, locale="fr-CA", reduced_motion="reduce")
    await campus.order_of("bob.martin", name_of(guest), "at_recipient")
    for address in ("/", campus.service.link_mailed_to(guest.email)):
        await stands(guest.page, address, one_moment="Chargement")
        look_at_guest = Looker(guest)
        await look_at_guest.look_at_words(address.partition("#")[0])
        await look_at_guest.moving(address.partition("#")[0])
        await Keyboard(guest.page).walk()
        looker.wrong += look_at_guest.wrong
    assert not looker.wrong, "\n".join(looker.wrong)


@pytest.mark.nightly
async def test_without_that_wish_a_way_is_seen_to_move(visit, campus):
    """So that the measure of motion is one."""
    ada = await visit("ada.king", at=campus.service, reduced_motion="no-preference")
    order_id = await campus.order_of(name_of(ada), "bob.martin", "carrying")
    await stands(ada.page, f"/follow.html?order={order_id}")
    await expect(ada.page.locator("svg .ahead").first).to_be_attached()  # a level line has no height to be seen by
    await ada.page.wait_for_function("() => document.getAnimations().length > 0")
    looker = Looker(ada)
    await looker.moving("follow")
    assert any("ahead" in one for one in looker.wrong)
