"""Signing in with a code from the mail."""

import re

import pytest
from playwright.async_api import expect

pytestmark = pytest.mark.browser


async def test_a_person_signs_in_with_the_code_from_their_mail(visit, service):
    ada = await visit("ada.king", on="phone", signed_in=False)
    page = ada.page
    await page.goto("/")
    await page.get_by_label("Email address").fill(ada.email)
    await page.get_by_role("button", name="Send me a code").click()
    code_field = page.get_by_label("Code from the email")
    await expect(code_field).to_be_focused()
    await code_field.fill(service.code_mailed_to(ada.email))
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await expect(page).to_have_title(re.compile("^Send a letter"))


@pytest.mark.parametrize("which", ["first", "second"])
async def test_a_code_is_sent_again_and_either_of_them_signs_in(visit, service, which):
    """Mails overtake each other: docs/decisions/0078-a-code-belongs-to-the-browser-that-asked.md."""
    ada = await visit("ada.king", on="phone", signed_in=False)
    page = ada.page
    await page.goto("/")
    await page.get_by_label("Email address").fill(ada.email)
    await page.get_by_role("button", name="Send me a code").click()
    await expect(page.get_by_label("Code from the email")).to_be_visible()
    (first,) = service.codes_mailed_to(ada.email, 1)
    await page.get_by_role("button", name="Send the code again").click()
    await expect(page.get_by_role("status")).to_have_text(re.compile(f"Another code is on its way to {ada.email}"))
    codes = service.codes_mailed_to(ada.email, 2)
    (second,) = {*codes} - {first}
    assert len(codes) == 2
    await page.get_by_label("Code from the email").fill({"first": first, "second": second}[which])
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()


async def test_a_wrong_code_is_refused_in_words_beside_the_field(visit, service):
    ada = await visit("ada.king", signed_in=False)
    ada.refusals_expected.add("/api/v1/sign-in")
    page = ada.page
    await page.goto("/")
    await page.get_by_label("Email address").fill(ada.email)
    await page.get_by_role("button", name="Send me a code").click()
    right = service.code_mailed_to(ada.email)
    code_field = page.get_by_label("Code from the email")
    await code_field.fill(f"{(int(right) + 1) % 10**8:08d}")
    await page.get_by_role("button", name="Sign in").click()
    await expect(code_field).to_have_accessible_description(re.compile("Wrong code"))
    await expect(code_field).to_be_focused()
    await code_field.fill(right)
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()


async def test_an_address_from_elsewhere_is_told_which_ones_there_are(visit):
    stranger = await visit(signed_in=False)
    stranger.refusals_expected.add("/api/v1/sign-in/codes")
    page = stranger.page
    await page.goto("/")
    email = page.get_by_label("Email address")
    await email.fill("eve@elsewhere.example")
    await page.get_by_role("button", name="Send me a code").click()
    await expect(email).to_have_accessible_description(re.compile("your campus address.*campus.example"))
    await email.fill("not an address")
    await page.get_by_role("button", name="Send me a code").click()
    await expect(email).to_have_accessible_description(re.compile("not an email address"))


@pytest.mark.slow
async def test_who_signs_out_is_asked_to_sign_in_again(visit):
    ada = await visit("ada.king")
    ada.refusals_expected.add("/api/v1/orders")  # what the page asked for while its session ended
    page = ada.page
    await page.goto("/mail.html")
    await page.locator("summary", has_text="Account: Ada King").click()
    await expect(page.get_by_text(ada.email)).to_be_visible()
    await page.get_by_role("button", name="Sign out").click()
    await expect(page.get_by_label("Email address")).to_be_visible()
    await page.goto("/mail.html")
    await expect(page.get_by_label("Email address")).to_be_visible()
