"""A session that ends under a page: its person signs in again over it, and goes on with what they typed."""

import re
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import pytest
from playwright.async_api import Locator, Page, expect

from app.models import Role
from tests.app.accounts.campus_provider import campus_provider, tell_of
from tests.app.robots.playing import until
from tests.web.keyboard import press
from tests.web.service import Service
from tests.web.test_offline import KEPT, sign_out
from tests.web.test_order import BOB, fill, send
from tests.web.test_outbox import ordered, placings
from tests.web.test_robots import give_roles
from tests.web.test_settings import NO_OVERFLOW
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser

SIGN_IN_AGAIN, WHY_NOT = "Sign in again", re.compile("You were signed out before this finished")
CHECKED = {"CAMPUS_MAIL_SESSION_CHECK_S": "1"}
NEXT_MAIL_LIMIT_S = 10.0


@pytest.fixture(scope="module")
def strict(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that checks each second that its listeners may still listen."""
    with Service(tmp_path_factory.mktemp("strict"), more=CHECKED) as service:
        yield service


def dialog_on(page: Page) -> Locator:
    return page.get_by_role("dialog", name=SIGN_IN_AGAIN)


async def sign_in_over(page: Page, person: Visitor, as_email: str = "") -> None:
    """By the code that is mailed now."""
    dialog, email = dialog_on(page), as_email or person.email
    before = person.service.code_mailed_to(email) if not as_email else ""
    if as_email:
        await dialog.get_by_label("Email address").fill(as_email)
    await dialog.get_by_role("button", name="Send me a code").click()
    await dialog.get_by_label("Code from the email").fill(code_after(person, email, before))
    await dialog.get_by_role("button", name="Sign in").click()


def code_after(person: Visitor, email: str, before: str) -> str:
    until_s = time.monotonic() + NEXT_MAIL_LIMIT_S
    while (code := person.service.code_mailed_to(email)) == before:
        assert time.monotonic() < until_s, "no new code was mailed"
        time.sleep(0.05)
    return code


@asynccontextmanager
async def session_that_ends_unheard(person: Visitor) -> AsyncIterator[None]:
    """The page has no stream that could tell it: what its person does next is refused."""
    await person.page.route(re.compile("/api/v1/live"), lambda route: route.abort())
    person.loses_answers = True
    yield
    await person.page.unroute_all()


@dataclass(frozen=True)
class Form:
    """One of the pages with what its person does there, and what the service then says was done."""

    address: Callable[[Visitor], Awaitable[str]]
    fill_in: Callable[[Page], Awaitable[Any]]
    button: str
    asked: str
    """The request to the service, and the compared fields of each item."""
    done: list[Any]
    typed: str = ""
    """A field that is as it was filled in as long as it is not done."""


def at(address: str) -> Callable[[Visitor], Awaitable[str]]:
    async def there(_: Visitor) -> str:
        return address

    return there


async def fill_in_standing(page: Page) -> None:
    await fill(page, what="Payroll")
    await page.get_by_role("radio", name="Repeat").check()
    await page.get_by_label("Time", exact=True).fill("09:30")


async def standing_order(ada: Visitor) -> str:
    every = {"weekdays": [0, 2], "at": "09:30", "zone": "America/Toronto"}
    await ada.post("/standing-orders", {"from_post": "post1", "to_post": "post4", "recipient": BOB, **every})
    return "/mail.html"


async def fill_in_nothing(page: Page) -> None:
    await expect(page.get_by_role("button", name=re.compile("^Pause: Bob"))).to_be_visible()


async def followed(ada: Visitor) -> str:
    async with Visitor(ada.browser, ada.service, f"bob.{ada.email}", ada.options) as bob:
        await bob.sign_in()
        return f"/follow.html?order={await bob.order(ada.email)}"


async def fill_in_delegate(page: Page) -> None:
    await page.get_by_text("Let another person meet the robot").click()
    await page.get_by_label("Their name").fill("The porter")


async def fill_in_contact(page: Page) -> None:
    book = page.get_by_role("region", name="Address book")
    await book.get_by_label("Email address").fill(BOB)
    await book.get_by_label("Display name").fill("Next door")


FORMS = {
    "order, again and again": Form(
        at("/"), fill_in_standing, "^Schedule repeats", "/standing-orders description", ["Payroll"], "Contents"
    ),
    "my mail": Form(standing_order, fill_in_nothing, "^Pause: Bob", "/standing-orders paused", [True]),
    "follow": Form(followed, fill_in_delegate, "^Add delegate", "/me/delegates name", ["The porter"], "Their name"),
    "settings": Form(
        at("/settings.html"), fill_in_contact, "^Save$", "/me/contacts label", ["Next door"], "Display name"
    ),
}


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.nightly
async def test_what_was_refused_is_done_by_one_tap_after_signing_in_in_place(visit, name):
    ada, form = await visit("ada.king", on="phone"), FORMS[name]
    await goes_on(ada, form)


async def goes_on(person: Visitor, form: Form) -> None:
    page, button = person.page, person.page.get_by_role("button", name=re.compile(form.button))
    async with session_that_ends_unheard(person):
        await page.goto(await form.address(person))
        await form.fill_in(page)
        typed = await page.get_by_label(form.typed).input_value() if form.typed else ""
        await person.end_sessions()
        await button.click()
        await expect(dialog_on(page)).to_be_visible()
    await sign_in_over(page, person)
    await expect(dialog_on(page)).to_be_hidden()
    await expect(page.get_by_text(WHY_NOT)).to_be_visible()
    if form.typed:
        await expect(page.get_by_label(form.typed)).to_have_value(typed)
    assert await done(person, form) != form.done, "nothing is done without their word"
    await button.click()
    await expect(page.get_by_text(WHY_NOT)).to_be_hidden()

    async def is_done() -> bool:
        return await done(person, form) == form.done

    await until(is_done)


async def done(person: Visitor, form: Form) -> list[Any]:
    path, _, what = form.asked.partition(" ")
    return [one[what] for one in (await person.api(path))["items"]]


@pytest.mark.nightly
async def test_what_saves_by_itself_can_be_saved_once_one_is_signed_in_again(visit):
    ada = await visit("ada.king")
    page = ada.page
    name, post = page.get_by_label("Name", exact=True), page.get_by_label("Usual post")
    async with session_that_ends_unheard(ada):
        await page.goto("/settings.html")
        await name.fill("Augusta Ada King")
        await ada.end_sessions()
        await post.focus()
        await expect(dialog_on(page)).to_be_visible()
    await sign_in_over(page, ada)
    await expect(name).to_have_value("Augusta Ada King")
    me = page.get_by_role("region", name="Profile")
    await me.get_by_role("button", name="Save").click()
    await expect(me.get_by_role("status")).to_have_text("Saved")
    assert (await ada.api("/me"))["name"] == "Augusta Ada King"


@pytest.mark.slow
async def test_a_refused_order_waits_in_sight_and_goes_out_once_with_its_key_at_one_tap(visit):
    ada = await visit("ada.king", on="phone")
    page, keys = ada.page, placings(ada.context)
    kept = page.get_by_role("region", name=KEPT)
    async with session_that_ends_unheard(ada):
        await page.goto("/")
        await fill(page, what="Ghost")
        await ada.end_sessions()
        await send(page)
        await expect(dialog_on(page)).to_be_visible()
    await sign_in_over(page, ada)
    await expect(kept).to_be_focused()
    await expect(kept.get_by_text(WHY_NOT)).to_be_visible()
    assert await ordered(ada) == []
    await kept.get_by_role("button", name="Send now").click()
    await expect(kept.get_by_text("Sent. Looking for a robot")).to_be_visible()
    assert await ordered(ada) == ["Ghost"] and len(keys) == 2 and len(set(keys)) == 1


@pytest.mark.nightly
async def test_at_the_desk_an_order_that_was_refused_goes_on_over_its_own_dialog(quiet_campus, visit):
    dana = await quiet_campus.dispatcher(visit)
    page, keys = dana.page, placings(dana.context)
    async with session_that_ends_unheard(dana):
        await page.goto("/mailroom.html")
        await press(page, "Order at the desk")
        await page.get_by_role("combobox", name="Sender").fill("grace.hill@campus.example")
        await page.get_by_role("combobox", name="Recipient").fill(BOB)
        await page.get_by_label("From", exact=True).select_option("Post 1")
        await page.get_by_label("To", exact=True).select_option("Post 4")
        await dana.end_sessions()
        await page.get_by_role("button", name="Place order").click()
        await expect(dialog_on(page)).to_be_visible()
    await sign_in_over(page, dana)
    await expect(page.get_by_role("combobox", name="Recipient")).to_have_value(BOB)
    assert len(keys) == 1
    await page.get_by_role("button", name="Place order").click()
    await expect(page.get_by_role("heading", name="Ordered")).to_be_visible()
    assert len(keys) == 2 and len(set(keys)) == 1


@pytest.mark.nightly
async def test_a_command_to_a_robot_that_was_refused_is_given_at_one_tap(quiet_campus, robot, visit):
    dana = await quiet_campus.dispatcher(visit)
    await give_roles(quiet_campus.service, dana.email, Role.DISPATCHER)
    page = dana.page
    async with session_that_ends_unheard(dana):
        await page.goto(f"/robots.html?robot={robot.name}")
        await press(page, "Pause")
        await page.get_by_label("Reason").fill("A parade")
        await dana.end_sessions()
        await page.get_by_role("button", name="Pause", exact=True).last.click()
        await expect(dialog_on(page)).to_be_visible()
    await sign_in_over(page, dana)
    await expect(page.get_by_label("Reason")).to_have_value("A parade")
    await page.get_by_role("button", name="Pause", exact=True).last.click()
    assert (await robot.hear("pause")).body.reason == "A parade"


@pytest.mark.nightly
async def test_one_sign_in_is_enough_for_all_tabs_and_each_goes_on_where_it_was(strict, visit):
    ada = await visit("ada.king", at=strict)
    first, second = ada.page, await ada.new_page()
    await first.goto("/")
    await second.goto("/settings.html")
    await fill(first, what="Half a")
    await fill_in_contact(second)
    await first.get_by_label("Contents").focus()
    await ada.end_sessions()
    for tab in (first, second):
        await expect(dialog_on(tab)).to_be_visible()
        await expect(dialog_on(tab).get_by_label("Email address")).to_have_value(ada.email)
    await sign_in_over(second, ada)
    for tab in (first, second):
        await expect(dialog_on(tab)).to_be_hidden()
    await expect(first.get_by_label("Contents")).to_be_focused()
    await first.keyboard.press("End")
    await first.keyboard.type(" letter")
    await expect(first.get_by_label("Contents")).to_have_value("Half a letter")
    await ada.order(BOB, what="From elsewhere")
    await expect(first.get_by_role("link", name=re.compile("From elsewhere"))).to_be_visible()
    await send(first)
    await first.wait_for_url("**/follow.html*")
    assert await ordered(ada) == ["Half a letter", "From elsewhere"]
    await expect(second.get_by_role("region", name="Address book").get_by_label("Email address")).to_have_value(BOB)


@pytest.mark.slow
async def test_where_another_person_signs_in_no_tab_shows_or_sends_what_was_the_first_ones(strict, visit):
    ada = await visit("ada.king", at=strict)
    eve = f"eve.{ada.email}"
    first, second = ada.page, await ada.new_page()
    for tab in (first, second):
        await tab.goto(f"/?description=Secret&recipient={BOB}")
        await expect(tab.get_by_label("Contents")).to_have_value("Secret")
    await ada.end_sessions()
    for tab in (first, second):
        await expect(dialog_on(tab)).to_be_visible()
    await sign_in_over(first, ada, as_email=eve)
    for tab in (first, second):
        await expect(tab.locator(".account summary", has_text="Eve Ada King")).to_be_attached()
        await expect(tab.get_by_label("Contents")).to_have_value("")
        await expect(tab.get_by_label("Recipient’s email")).to_have_value("")
    assert await ordered(ada) == [], "the browser is Eve's now"


@pytest.mark.slow
async def test_who_leaves_on_purpose_is_not_asked_to_come_back_in_any_tab(strict, visit):
    ada = await visit("ada.king", at=strict)
    ada.loses_session = True
    first, second = ada.page, await ada.new_page()
    asked = []
    for tab in (first, second):
        tab.on("request", lambda request: asked.append(request.url) if "sign_in_again.js" in request.url else None)
        await tab.goto("/settings.html")
        await expect(tab.get_by_role("region", name="Address book")).to_be_visible()
    await second.goto("/mail.html")
    await sign_out(first)
    await expect(second.get_by_role("button", name="Send me a code")).to_be_visible()
    await expect(second.get_by_role("heading", name="My mail")).to_be_hidden()
    assert not asked
    await second.go_back()
    await expect(second.get_by_role("button", name="Send me a code")).to_be_visible()


@pytest.mark.nightly
async def test_who_does_not_care_to_sign_in_now_reads_on_and_is_asked_when_they_do_something(strict, visit):
    ada = await visit("ada.king", at=strict, on="phone", viewport={"width": 320, "height": 640}, locale="fr-CA")
    page = ada.page
    dialog = page.get_by_role("dialog", name="Se reconnecter")
    await page.goto("/settings.html")
    await page.get_by_label("Nom affiché").fill("Bob")
    await page.get_by_label("Nom affiché").focus()
    await ada.end_sessions()
    await expect(dialog.get_by_role("button", name="M’envoyer un code")).to_be_focused()
    assert await page.evaluate(NO_OVERFLOW)
    await ada.assert_accessible()
    await page.keyboard.press("Escape")
    await expect(dialog).to_be_hidden()
    await expect(page.get_by_label("Nom affiché")).to_be_focused()
    await expect(page.get_by_text("Vous n’êtes plus connecté·e.")).to_be_visible()
    assert await page.evaluate(NO_OVERFLOW)
    await ada.assert_accessible()
    book = page.get_by_role("region", name="Carnet")
    await book.get_by_label("Adresse e-mail").fill(BOB)
    await book.get_by_role("button", name="Enregistrer", exact=True).click()
    await expect(dialog).to_be_visible()
    await page.keyboard.press("Escape")
    await page.get_by_role("button", name="Se reconnecter").click()
    await expect(dialog).to_be_visible()


@pytest.fixture(scope="module")
def campus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Service, str]]:
    with campus_provider() as issuer:
        client = {"CAMPUS_MAIL_OIDC_CLIENT_ID": "campus-mail", "CAMPUS_MAIL_OIDC_CLIENT_SECRET": "between us"}
        more = {"CAMPUS_MAIL_OIDC_ISSUER": issuer, **client, **CHECKED}
        with Service(tmp_path_factory.mktemp("with_provider"), more=more) as service:
            yield service, issuer


@pytest.mark.nightly
async def test_the_campus_sign_in_opens_beside_the_form_which_goes_on(campus, visit):
    service, issuer = campus
    ada = await visit("ada.king", at=service)
    tell_of(issuer, "ada", email=ada.email, email_verified=True, name="Ada King")
    page = ada.page
    await page.goto("/")
    await fill(page, what="Half a letter")
    await ada.end_sessions()
    await expect(dialog_on(page).get_by_text("in a new tab")).to_be_visible()
    async with page.expect_popup() as opened:
        await dialog_on(page).get_by_role("link", name="Sign in with your campus account").click()
    there = await opened.value
    await there.get_by_role("textbox").first.fill("ada")
    await there.get_by_role("button", name="Authorize").click()
    await expect(dialog_on(page)).to_be_hidden()
    await send(page)
    await page.wait_for_url("**/follow.html*")
    assert await ordered(ada) == ["Half a letter"]
