"""Names and whatever else people write are one printable line: no paragraphs of theirs in mails, on pages, in logs."""

import re
import subprocess
import sys
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlmodel import col, update

from app.models import Person
from protocol.to_server import Fault
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, Mails

PARAGRAPH = "Eve\r\n\r\nYour account ends today:\u2028https://evil.example/"
HEADERS = {
    *("From", "To", "Subject", "Date", "Message-ID", "Auto-Submitted"),
    *("Content-Type", "Content-Transfer-Encoding", "MIME-Version"),
}
UNPRINTABLE = (
    "\r\n",
    "\n",
    "\x00",
    "\x1b",
    "\x85",
    "\u2028",
    "\u2029",
    "\u200b",
    "\u200f",
    "\u202e",
    "\u2067",
    "\ufeff",
)


def bodies_of(document: dict[str, Any]) -> set[str]:
    """The names of all schemas of which a request may hold a part."""
    asked = [one["requestBody"] for path in document["paths"].values() for one in path.values() if "requestBody" in one]
    found, new = set[str](), names_in(asked)
    while new:
        found |= new
        new = names_in([document["components"]["schemas"][name] for name in new]) - found
    return found


def names_in(part: Any) -> set[str]:
    return set(re.findall(r"#/components/schemas/(\w+)", repr(part)))


def texts_in(schema: Any) -> list[dict[str, Any]]:
    """The free texts of a schema: strings of no closed vocabulary and no format."""
    if isinstance(schema, list):
        return [text for one in schema for text in texts_in(one)]
    if not isinstance(schema, dict):
        return []
    is_free = schema.get("type") == "string" and not {"enum", "const", "format"} & schema.keys()
    return ([schema] if is_free else []) + [text for one in schema.values() for text in texts_in(one)]


def test_no_text_of_any_request_takes_more_than_one_printable_line(app: FastAPI) -> None:
    document = app.openapi()
    taken = [
        (name, field, mark)
        for name in bodies_of(document)
        for field, schema in document["components"]["schemas"][name].get("properties", {}).items()
        for text in texts_in(schema)
        for mark in UNPRINTABLE
        if re.fullmatch(text.get("pattern", "(?s:.*)"), f"a{mark}b")
        or ("maxLength" not in text and "pattern" not in text)
    ]
    assert taken == [("NewStandingOrder", "zone", mark) for mark in UNPRINTABLE], "a zone is one of a list"


def test_what_people_are_called_has_eighty_characters_and_stays_on_its_line(
    sender: Browser, anonymous: TestClient
) -> None:
    order_id = sender.order().json()["id"]
    places = (
        ("PATCH", "/api/v1/me", {}),
        ("POST", f"/api/v1/orders/{order_id}/delegates", {}),
        ("POST", "/api/v1/tokens", {"scopes": ["orders:read"]}),
    )
    for method, path, more in places:
        for name in (PARAGRAPH, "\u202eevE", "x" * 81):
            answer = sender.request(method, path, json={"name": name, **more})
            assert (answer.status_code, answer.json()["code"]) == (422, "invalid_request"), (path, name)
        said = sender.request(method, path, json={"name": PARAGRAPH, **more}).json()["errors"]
        assert said == [{"field": "name", "message": "Must be one line without invisible characters"}]
        taken = sender.request(method, path, json={"name": f" {'é' * 79}ß\n", **more})
        assert taken.json()["name"] == "é" * 79 + "ß", "what surrounds it is cut off"
    persian = "می\u200cخواهم"
    assert sender.patch("/api/v1/me", json={"name": persian}).json()["name"] == persian, "joiners are letters' own"
    too_long = sender.put("/api/v1/me/contacts/bob@campus.example", json={"label": "x" * 81})
    assert too_long.status_code == 422
    for wish in ({"description": PARAGRAPH}, {"description": "a\u2066b"}):
        assert sender.order(**wish).status_code == 422


def test_a_long_address_makes_no_long_name(anonymous: TestClient, mails: Mails) -> None:
    email = f"{'long.' * 30}name@campus.example"
    anonymous.post("/api/v1/sign-in/codes", json={"email": email})
    person = anonymous.post("/api/v1/sign-in", json={"email": email, "code": mails.newest_code(email)}).json()
    assert len(person["name"]) <= 80
    assert person["name"].startswith("Long Long")


def test_a_name_that_was_stored_before_writes_no_paragraph_into_a_mail(
    sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    mailroom.call(_rename, mailroom, f"{PARAGRAPH}\u202e")
    order_id = sender.order().json()["id"]
    sender.post(f"/api/v1/orders/{order_id}/delegates", json={"name": "Dee", "email": "dee@campus.example"})
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying")
    mailroom.send_mails()
    written = [mail for one in (RECIPIENT, "dee@campus.example") for mail in mails.to(one)]
    assert len(written) == 2
    for mail in written:
        body = mail.get_body(("plain",))
        assert body
        text = f"{mail['Subject']}\n{body.get_content()}"
        assert "Eve Your account ends today: https://evil.example/" in text
        assert text.count("Your account") == text.count("Eve Your account"), "never at the beginning of a line"
        assert not re.search("[\u2028\u202e]", text)


@pytest.mark.parametrize("hidden", ["=0d=0aBcc:_eve@evil.example=0d=0a=0d=0aPay_Eve", "=E2=80=AEdiaP", "=E2=80=A8Paid"])
def test_a_name_hides_no_line_in_the_letters_of_a_mails_header(
    sender: Browser, mailroom: Mailroom, mails: Mails, hidden: str
) -> None:
    """`=?utf-8?q?…?=` stands for other letters in a header, also for those that a name may not have."""
    assert sender.patch("/api/v1/me", json={"name": f"=?utf-8?q?{hidden}?="}).status_code == 200
    mailroom.move(sender.order().json()["id"], "assigned", "to_sender", "at_sender", "carrying")
    mailroom.send_mails()
    (raw,) = [file.read_bytes() for file in mails.folder.iterdir() if RECIPIENT.encode() in file.read_bytes()]
    head = raw.partition(b"\r\n\r\n")[0].decode("ascii")
    assert "\n" not in head.replace("\r\n", "")
    assert {line.partition(":")[0] for line in head.split("\r\n") if line[0] != " "} == HEADERS
    (mail,) = mails.to(RECIPIENT)
    assert str(mail["Subject"]).isprintable()
    assert hidden in mail["Subject"], "it is shown as it was written"


async def _rename(mailroom: Mailroom, name: str) -> None:
    async with mailroom.app.state.parts.database.transaction() as session:
        await session.exec(update(Person).where(col(Person.email) == SENDER).values(name=name))


@pytest.mark.parametrize("mark", UNPRINTABLE[:2] + UNPRINTABLE[3:])
def test_a_robots_sentence_is_one_line_wherever_it_goes(mark: str) -> None:
    fault = Fault.model_validate_json(
        Fault(name="blocked", happened_at="2026-01-01T00:00:00Z", reason="A box")  # type: ignore[arg-type]
        .model_dump_json()
        .replace("A box", f"A box{mark.encode('unicode_escape').decode().replace(chr(92) + 'x', chr(92) + 'u00')}here")
    )
    assert fault.reason in ("A box here", "A boxhere")


def test_a_line_of_the_log_at_a_terminal_stays_one_line() -> None:
    says = "import structlog; structlog.get_logger().warning('answered', path='/a\\r\\x1b[2K\\u2028b\\u202ec')"
    program = f"from app.core.logs import set_up_logs; set_up_logs('INFO', as_json=False); {says}"
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stderr
    assert r"path=/a\r\x1b[2K\u2028b\u202ec" in said
    assert said.strip().isprintable()
