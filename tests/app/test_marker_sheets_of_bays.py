"""The printer's sheets on a map with bays: each bay has its own, as each post has."""

import pytest

from app.accounts.sign_in.service import find_person, set_roles
from app.core.settings import Settings
from app.models import Role
from tests.app.conftest import Mailroom, SignedIn
from tests.app.traffic.bay_travelling import MAP


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"map": str(MAP)})


def test_a_bay_has_a_marker_sheet_of_its_own(signed_in: SignedIn, mailroom: Mailroom) -> None:
    browser = signed_in("dispatcher@campus.example")

    async def promote() -> None:
        async with mailroom.app.state.parts.database.transaction() as session:
            person = await find_person(session, "dispatcher@campus.example")
            assert person
            set_roles(person, {Role.DISPATCHER}, set())

    mailroom.call(promote)
    answer = browser.get("/api/v1/map/posts/post5_bay2/marker.svg")
    assert answer.headers["content-type"] == "image/svg+xml"
    assert "2 of these at this bay" in answer.text, "one before its end, one beside the dock"
    assert browser.get("/api/v1/map/posts/post5_bay9/marker.svg").status_code == 404
