"""Delegates hand over with a code of their own, which can be revoked."""

from hashlib import sha256
from typing import Any

import httpx
import pytest

from app.accounts.sign_in.service import set_roles
from app.models import Handover, Role
from app.retention.order_records import one_order
from app.retention.personal import everything_of, person_of
from protocol.parts import Stop
from protocol.to_robot import Verifiers
from protocol.to_server import Step
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


# Sender and recipient name a delegate each; who reads of them by which name, and of whom it is said that they were one.
NOT_AT_ALL = (None, None)
SEEN: dict[str, tuple[str | None, str | None]] = {
    "sender": ("The porter", None),
    "recipient": (None, "A neighbour"),
    "dispatcher": ("The porter", "A neighbour"),
    "maintainer": NOT_AT_ALL,
    "stranger": NOT_AT_ALL,
}


async def test_a_delegates_name_is_for_the_side_that_named_them_and_for_dispatchers(campus: Campus) -> None:
    roles = {"dispatcher": (Role.DISPATCHER,), "maintainer": (Role.MAINTAINER,)}
    people = {who: await campus.browser(who, *roles.get(who, ())) for who in SEEN}
    await campus.waits_for_load()
    await hands_over(campus, people["sender"], "The porter", campus.load)
    assert campus.mission
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.ARRIVED, campus.receive))
    await hands_over(campus, people["recipient"], "A neighbour", campus.receive)
    for who, names in SEEN.items():
        answer = await people[who].get(campus.path)
        if names is NOT_AT_ALL:
            assert answer.status_code == 404, who
            continue
        of_sender, of_recipient = names
        told = [(one["holder"], one["name"], one["confirmed_by"], one["confirmed_by_name"]) for one in custody(answer)]
        assert told[1:] == [
            ("robot", "r1", "delegate", of_sender),
            ("delegate", of_recipient, "delegate", of_recipient),
        ], who
        read = [event["reason"] for event in answer.json()["events"] if event["kind"] == "delegate_named"]
        assert read == [of_sender, of_recipient], who
        (listed,) = (await people[who].get("/orders")).json()["items"]
        for name in ("The porter", "A neighbour"):
            assert (name in answer.text, name in str(listed)) == (name in names, name in names), (who, name)
    async with campus.service.app.state.parts.database.reading() as session:
        assert (await one_order(session, campus.order_id))["custody"][-1]["delegate"] == "A neighbour"
        for who in ("sender", "recipient"):  # nor in what they are given of all that is known of them
            exported = str(await everything_of(session, await person_of(session, f"{who}@campus.example")))
            for name in ("The porter", "A neighbour"):
                assert (name in exported) == (name in SEEN[who]), (who, name)


async def hands_over(campus: Campus, who: httpx.AsyncClient, name: str, stop: Stop) -> None:
    """`who` names this delegate, whose code the robot sees."""
    named = await who.post(f"{campus.path}/delegates", json={"name": name})
    theirs = sha256((await who.get(named.headers["Location"][7:])).json()["text"].encode()).hexdigest()
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(stop, code_sha256=theirs)))


def custody(answer: httpx.Response) -> list[dict[str, Any]]:
    chain: list[dict[str, Any]] = answer.json()["custody"]
    return chain


async def test_a_revoked_delegates_code_is_taken_from_the_robot_and_no_longer_shown(campus: Campus) -> None:
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
async def test_sender_and_recipient_each_name_a_delegate_for_their_own_hand_over(
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


async def test_when_the_mail_is_aboard_no_delegate_is_named_to_load_it(campus: Campus) -> None:
    await campus.waits_for_recipient()
    sender = await campus.browser("sender")
    late = await sender.post(f"{campus.path}/delegates", json={"name": "The porter"})
    assert (late.status_code, late.json()["code"]) == (409, "too_late_to_delegate")
    back = await sender.post(f"{campus.path}/delegates", json={"name": "The porter", "purpose": "return"})
    assert back.status_code == 201


async def test_everybody_whom_i_have_named_is_in_one_list_until_their_hand_over_is_done(campus: Campus) -> None:
    await campus.waits_for_load()
    sender, recipient = await campus.browser("sender"), await campus.browser("recipient")
    assert (await mine(sender), await mine(recipient)) == ([], [])
    for name, purpose in (("The porter", "load"), ("A clerk", "return")):
        await sender.post(f"{campus.path}/delegates", json={"name": name, "purpose": purpose})
    await recipient.post(f"{campus.path}/delegates", json={"name": "A neighbour"})
    porter, clerk = sorted(await mine(sender), key=lambda one: str(one["name"]), reverse=True)
    seen = (porter["name"], porter["purpose"], porter["post"], porter["my_role"])
    assert seen == ("The porter", "load", "post1", "sender")
    assert (porter["order_id"], porter["recipient"]["email"]) == (campus.order_id, "recipient@campus.example")
    assert porter["expires_at"] == (await sender.get(f"{campus.path}/code")).json()["expires_at"]
    (neighbour,) = await mine(recipient)
    assert (neighbour["name"], neighbour["post"], neighbour["my_role"]) == ("A neighbour", "post4", "recipient")
    await sender.delete(f"{campus.path}/delegates/{clerk['id']}")
    assert [one["name"] for one in await mine(sender)] == ["The porter"]
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.load)))
    assert await mine(sender) == [], "the mail is aboard"
    assert [one["name"] for one in await mine(recipient)] == ["A neighbour"]
    assert campus.mission
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.ARRIVED, campus.receive))
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.receive)))
    assert await mine(recipient) == [], "and now it is delivered"


async def test_whom_a_dispatcher_has_named_is_no_longer_theirs_to_see_without_the_role(campus: Campus) -> None:
    await campus.connect()
    desk = await campus.browser("desk", Role.DISPATCHER)
    for name in ("A neighbour", "Another"):
        await desk.post(f"{campus.path}/delegates", json={"name": name, "purpose": "receive"})
    first = (await desk.get("/me/delegates?limit=1")).json()
    rest = (await desk.get(f"/me/delegates?limit=1&cursor={first['next']}")).json()
    assert {one["items"][0]["name"] for one in (first, rest)} == {"A neighbour", "Another"}
    assert rest["next"] is None
    async with campus.service.app.state.parts.database.transaction() as session:
        set_roles(await person_of(session, "desk@campus.example"), set(), {Role.DISPATCHER})
    assert await mine(desk) == []


async def mine(who: httpx.AsyncClient) -> list[dict[str, Any]]:
    answer = await who.get("/me/delegates")
    assert answer.status_code == 200, answer.text
    items: list[dict[str, Any]] = answer.json()["items"]
    return items
