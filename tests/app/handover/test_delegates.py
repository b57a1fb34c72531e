"""Somebody else hands over: named with a code of their own, which can be taken back."""

from hashlib import sha256
from typing import Any

import pytest

from app.keeping.order_records import one_order
from app.tables import Handover, Role
from protocol.to_robot import Verifiers
from tests.app.handover.conftest import Campus


async def told_codes(campus: Campus) -> set[str]:
    """The codes that open the hand-over to load, as the robot was told last."""
    verifiers = (await campus.robot.hear("verifiers")).body
    assert isinstance(verifiers, Verifiers)
    return {one.sha256 for one in verifiers.verifiers if one.purpose == "load"}


async def test_a_delegate_has_a_code_of_their_own_and_the_receipt_says_that_it_was_them(campus: Campus) -> None:
    await campus.waits_for_load()
    sender = await campus.browser("sender")
    named = await sender.post(f"{campus.path}/delegates", json={"name": " The porter "})
    assert named.status_code == 201
    delegate = named.json()
    assert (delegate["name"], delegate["purpose"], delegate["revoked_at"]) == ("The porter", "load", None)
    before = set(campus.robot.codes(campus.load))
    (theirs,) = await told_codes(campus) - before
    mine = (await sender.get(f"{campus.path}/code")).json()
    code = (await sender.get(named.headers["Location"][7:])).json()
    assert code["text"] != mine["text"]
    assert code["digits"].isdecimal()
    assert (await sender.get(code["svg_url"][7:])).headers["content-type"] == "image/svg+xml"
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.load, code_sha256=theirs)))
    written = await campus.service.row(Handover, order_id=campus.order_id)
    assert (written.holder, written.delegate_id, written.person_id) == ("delegate", delegate["id"], None)
    assert await campus.state() == "carrying"
    assert await campus.kinds() == ["delegate_named"]
    aboard = (await sender.get(campus.path)).json()["custody"][-1]
    assert (aboard["name"], aboard["confirmed_by"], aboard["confirmed_by_name"]) == ("r1", "delegate", "The porter")


async def test_the_chain_of_custody_says_which_delegate_has_the_mail_to_sender_and_recipient(campus: Campus) -> None:
    await campus.waits_for_recipient()
    sender, recipient = await campus.browser("sender"), await campus.browser("recipient")
    for name in ("A neighbour", "The porter"):
        named = await recipient.post(f"{campus.path}/delegates", json={"name": name})
    theirs = sha256((await recipient.get(named.headers["Location"][7:])).json()["text"].encode()).hexdigest()
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.receive, code_sha256=theirs)))
    for browser in (sender, recipient):
        last = (await browser.get(campus.path)).json()["custody"][-1]
        assert (last["holder"], last["name"], last["to"]) == ("delegate", "The porter", None)
    async with campus.service.app.state.database.reading() as session:
        assert (await one_order(session, campus.order_id))["custody"][-1]["delegate"] == "The porter"


async def test_a_revoked_delegates_code_is_taken_from_the_robot_and_shown_to_nobody(campus: Campus) -> None:
    await campus.waits_for_load()
    sender = await campus.browser("sender")
    own = set(campus.robot.codes(campus.load))
    delegate = (await sender.post(f"{campus.path}/delegates", json={"name": "The porter"})).json()
    assert len(await told_codes(campus)) == 2
    path = f"{campus.path}/delegates/{delegate['id']}"
    digits = (await sender.get(f"{path}/code")).json()["digits"]
    assert (await sender.delete(path)).status_code == 204
    assert await told_codes(campus) == own
    assert (await sender.get(f"{path}/code")).status_code == 404
    (listed,) = (await sender.get(f"{campus.path}/delegates")).json()["items"]
    assert listed["revoked_at"]
    typed = await sender.post(f"{campus.path}/handover", json={"digits": digits})
    assert (typed.status_code, typed.json()["code"]) == (422, "wrong_digits")
    assert (await sender.delete(path)).status_code == 204, "once more changes nothing"
    assert await campus.kinds() == ["delegate_named", "delegate_revoked"]


async def test_a_delegate_with_an_address_of_the_campus_taps_for_themselves_and_sees_no_order(campus: Campus) -> None:
    await campus.waits_for_load()
    sender, porter = await campus.browser("sender"), await campus.browser("porter")
    assert (await porter.get(f"{campus.path}/code")).status_code == 404
    wish = {"name": "The porter", "email": "porter@campus.example"}
    assert (await sender.post(f"{campus.path}/delegates", json=wish)).status_code == 201
    assert (await porter.get(f"{campus.path}/code")).json()["purpose"] == "load"
    assert (await porter.post(f"{campus.path}/handover", json={})).status_code == 202
    assert (await porter.get(campus.path)).status_code == 404


@pytest.mark.parametrize(
    ("who", "wish", "status", "code"),
    [
        ("recipient", {"purpose": "load"}, 403, "not_yours_to_delegate"),
        ("sender", {"purpose": "receive"}, 403, "not_yours_to_delegate"),
        ("stranger", {}, 404, "unknown_order"),
        ("sender", {"name": " "}, 422, "invalid_request"),
    ],
)
async def test_each_names_somebody_for_their_own_hand_over(
    campus: Campus, who: str, wish: dict[str, Any], status: int, code: str
) -> None:
    await campus.connect()
    answer = await (await campus.browser(who)).post(f"{campus.path}/delegates", json={"name": "X", **wish})
    assert (answer.status_code, answer.json()["code"]) == (status, code)


async def test_a_delegate_is_seen_by_those_whose_they_are(campus: Campus) -> None:
    await campus.connect()
    sender, recipient = await campus.browser("sender"), await campus.browser("recipient")
    delegate = (await recipient.post(f"{campus.path}/delegates", json={"name": "A neighbour"})).json()
    assert delegate["purpose"] == "receive"
    assert (await sender.get(f"{campus.path}/delegates")).json()["items"] == []
    path = f"{campus.path}/delegates/{delegate['id']}"
    assert [(await sender.get(f"{path}/code")).status_code, (await sender.delete(path)).status_code] == [404, 404]
    desk = await campus.browser("desk", Role.DISPATCHER)
    assert len((await desk.get(f"{campus.path}/delegates")).json()["items"]) == 1


async def test_when_the_mail_is_aboard_nobody_is_named_to_load_it(campus: Campus) -> None:
    await campus.waits_for_recipient()
    sender = await campus.browser("sender")
    late = await sender.post(f"{campus.path}/delegates", json={"name": "The porter"})
    assert (late.status_code, late.json()["code"]) == (409, "too_late_to_delegate")
    back = await sender.post(f"{campus.path}/delegates", json={"name": "The porter", "purpose": "return"})
    assert back.status_code == 201
