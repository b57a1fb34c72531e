"""Signing in at the campus itself, from the first page to the provider and back."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.async_api import Page, expect

from tests.app.accounts.campus_provider import campus_provider, tell_of
from tests.web.service import Service
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser


@dataclass(frozen=True)
class Campus:
    """A service and the provider that it trusts."""

    service: Service
    issuer: str


@pytest.fixture(scope="module")
def campus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Campus]:
    with campus_provider() as issuer:
        folder: Path = tmp_path_factory.mktemp("with_provider")
        client = {"CAMPUS_MAIL_OIDC_CLIENT_ID": "campus-mail", "CAMPUS_MAIL_OIDC_CLIENT_SECRET": "between us"}
        with Service(folder, more={"CAMPUS_MAIL_OIDC_ISSUER": issuer, **client}) as service:
            yield Campus(service, issuer)


PROVIDERS_OWN = ("picocss", "favicon.ico")
"""Requests of its page that fail here, without a network."""


async def sign_in_there(visitor: Visitor, subject: str) -> Page:
    page = visitor.page
    await page.goto("/")
    await page.get_by_role("link", name="Sign in with your campus account").click()
    await page.get_by_role("textbox").first.fill(subject)
    await page.get_by_role("button", name="Authorize").click()
    await expect(page).to_have_url(f"{visitor.service.url}/")
    visitor.complaints[:] = [one for one in visitor.complaints if not any(own in one for own in PROVIDERS_OWN)]
    return page


@pytest.mark.nightly
async def test_a_person_comes_in_by_their_campus_account(visit, campus):
    tell_of(campus.issuer, "ada", email="ada@campus.example", email_verified=True, name="Ada Lovelace")
    page = await sign_in_there(await visit("ada", at=campus.service, signed_in=False), "ada")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()


@pytest.mark.slow
async def test_a_person_who_is_refused_there_reads_why_and_is_asked_for_an_address(visit, campus):
    tell_of(campus.issuer, "eve", email="eve@campus.example", email_verified=False)
    page = await sign_in_there(await visit("eve", at=campus.service, signed_in=False), "eve")
    await expect(page.get_by_text("The campus has not verified your email address.")).to_be_visible()
    await expect(page.get_by_label("Email address")).to_be_visible()
    await page.reload()
    await expect(page.get_by_label("Email address")).to_be_visible()
    await expect(page.get_by_text("The campus has not verified your email address.")).to_have_count(0)


async def test_without_a_campus_sign_in_there_is_no_way_to_it(visit):
    page = (await visit(signed_in=False)).page
    await page.goto("/")
    await expect(page.get_by_label("Email address")).to_be_visible()
    await expect(page.get_by_role("link", name="Sign in with your campus account")).to_have_count(0)
