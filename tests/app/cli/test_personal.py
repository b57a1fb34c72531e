"""A person's data is exported for them, or erased."""

import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app.core.settings import Settings
from app.models import metadata
from app.retention.erasure import FATES
from app.retention.personal import references_to_people
from tests.app.cli.conftest import Run
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, Mails, SignedIn

Ask = Callable[..., Any]
NAME = "Ada Lovelace-King"


def delivered(sender: Browser, mailroom: Mailroom) -> str:
    order_id: str = sender.order(description=f"For {NAME}").json()["id"]
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    mailroom.send_mails()
    return order_id


def test_a_person_gets_everything_about_them_and_no_secret(
    run: Run, ask: Ask, sender: Browser, mailroom: Mailroom, tmp_path: Path
) -> None:
    order_id = delivered(sender, mailroom)
    rows = ask("export", RECIPIENT, "--to", str(tmp_path / "folder"))["rows"]
    assert rows["orders"] == 1
    (order,) = json.loads((tmp_path / "folder" / "orders.json").read_text())
    assert (order["id"], order["events"][-1]["state"]) == (order_id, "delivered")
    assert json.loads((tmp_path / "folder" / "notices.json").read_text())[0]["order_id"] == order_id
    assert run("export", SENDER, "--to", str(tmp_path / "all.zip")).exit_code == 0
    with zipfile.ZipFile(tmp_path / "all.zip") as archive:
        texts = {name: archive.read(name).decode() for name in archive.namelist()}
    assert json.loads(texts["person.json"])["email"] == SENDER
    assert texts["sessions.json"]
    assert not any("hash" in text for text in texts.values())
    assert (tmp_path / "all.zip").stat().st_mode & 0o777 == 0o600
    assert run("export", SENDER, "--to", str(tmp_path / "all.zip")).exit_code == 2


def test_who_is_erased_is_found_nowhere_and_the_order_stays(
    run: Run, ask: Ask, signed_in: SignedIn, sender: Browser, mailroom: Mailroom, mails: Mails, settings: Settings
) -> None:
    order_id = delivered(sender, mailroom)
    assert mails.to(SENDER)
    assert ask("erase", SENDER, "--yes")["orders_kept"] == 1
    assert sender.get("/api/v1/orders").status_code == 401
    shown = ask("orders", "show", order_id)
    assert shown["sender"].endswith("@erased.invalid")
    assert (shown["description"], shown["state"], shown["recipient"]) == (None, "delivered", RECIPIENT)
    assert mails.to(SENDER) == []
    everything = mailroom.call(_whole_database, mailroom)
    assert SENDER not in everything
    assert NAME not in everything
    assert RECIPIENT in everything


async def _whole_database(mailroom: Mailroom) -> str:
    async with mailroom.app.state.parts.database.reading() as session:
        connection = await session.connection()
        return "\n".join([str((await connection.execute(table.select())).all()) for table in metadata.sorted_tables])


def test_a_delegate_who_is_erased_is_found_nowhere(ask: Ask, sender: Browser, mailroom: Mailroom, mails: Mails) -> None:
    """Neither their account, which their mail has made, nor the name by which others called them."""
    order_id = sender.order().json()["id"]
    wish = {"name": "Eve of the porters", "email": "eve@campus.example"}
    named = sender.post(f"/api/v1/orders/{order_id}/delegates", json=wish)
    assert named.status_code == 201
    mailroom.send_mails()
    assert mails.to(wish["email"])
    ask("erase", wish["email"], "--yes")
    everything = mailroom.call(_whole_database, mailroom)
    assert wish["name"] not in everything
    assert wish["email"] not in everything
    assert mails.to(wish["email"]) == []


def test_no_person_is_erased_while_their_mail_is_under_way(run: Run, sender: Browser, mailroom: Mailroom) -> None:
    order_id = sender.order().json()["id"]
    for email in (SENDER, RECIPIENT):
        refused = run("erase", email, "--yes")
        assert (refused.exit_code, refused.stdout) == (2, "")
        assert order_id in refused.stderr
    assert sender.get("/api/v1/orders").status_code == 200


def test_the_last_maintainer_cannot_be_erased_and_no_person_by_a_slip(run: Run, sender: Browser) -> None:
    run("people", "role", SENDER, "--add", "maintainer")
    assert "last maintainer" in run("erase", SENDER, "--yes").stderr
    assert "Nothing was erased" in run("erase", SENDER).stderr


def test_every_table_that_refers_to_people_has_a_fate() -> None:
    """Every new table states what becomes of its rows when a person is erased."""
    assert {table.name for table, _ in references_to_people()} == set(FATES)
