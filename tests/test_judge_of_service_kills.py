"""The judge of the service's kills has nothing against a run in order, and names each thing that is not."""

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import pytest

from benchmarks.service_kills.judge import Facts, judged, mails_repeated

LIFE = ("queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
TOLD = [
    ("ada", "accepted"), ("ada", "robot_here"), ("ada", "delivered"),
    ("bob", "on_its_way"), ("bob", "robot_here_for_you"), ("bob", "delivered"),
]  # fmt: skip


def in_order() -> dict[str, Any]:
    """One order that was delivered, everybody told, every message where it belongs."""
    who = ["sender", "dispatcher", *["robot"] * 5]
    events = [
        {"order_id": "o1", "seq": n, "state": state, "by": by, "kind": "moved"}
        for n, (state, by) in enumerate(zip(LIFE, who, strict=True), start=1)
    ]
    notices = [
        {"id": n, "order_id": "o1", "person_id": person, "kind": kind, "routed_at": "now"}
        for n, (person, kind) in enumerate(TOLD)
    ]
    outbox = [
        {"key": f"mail.{n}", "notice_id": n, "channel": "mail", "sent_at": "now", "problem": None}
        for n in range(len(TOLD))
    ]
    return {
        "tables": {
            "orders": [{"id": "o1", "state": "delivered", "sender_id": "ada", "recipient_id": "bob"}],
            "order_events": events,
            "handovers": [
                {"order_id": "o1", "purpose": purpose, "evidence": "proof", "problem": None}
                for purpose in ("load", "receive")
            ],
            "refused_receipts": [],
            "notices": notices,
            "outbox": outbox,
            "robot_messages": [{"robot": "r1", "seq": n, "body": {"n": n}} for n in (1, 2)],
            "server_outbox": [{"robot": "r1", "seq": 1, "type": "mission", "acked_at": "now"}],
        },
        "acknowledged": {"k1": "o1"},
        "said": {"r1": {n: {"n": n} for n in (1, 2)}},
        "mail_ids": [f"<mail.{n}@campus.example>" for n in range(len(TOLD))],
    }


def test_a_run_in_order_is_not_blamed_and_a_mail_repeated_under_its_id_is_counted() -> None:
    facts = in_order()
    facts["mail_ids"].append(facts["mail_ids"][0])
    assert judged(Facts(**facts)) == []
    assert mails_repeated(Facts(**facts)) == 1


Damage = Callable[[dict[str, Any]], object]


@pytest.mark.parametrize(
    ("damage", "named"),
    [
        (lambda f: f["acknowledged"].update(k2="o2"), "order o2 was acknowledged to k2 and is lost"),
        (lambda f: f["acknowledged"].update(k2="o1"), "order o1 was the answer to 2 keys"),
        (lambda f: f["acknowledged"].clear(), "order o1 is there, and it was not reported: a double"),
        (lambda f: f["tables"]["order_events"].pop(0), "its life does not begin with the queue"),
        (lambda f: f["tables"]["order_events"].pop(), "its last event says at_recipient"),
        (lambda f: f["tables"]["order_events"].pop(3), "carrying followed to_sender on the word of robot"),
        (
            lambda f: f["tables"]["order_events"][2].update(by="sender"),
            "to_sender followed assigned on the word of sender",
        ),
        (lambda f: f["tables"]["orders"][0].update(state="carrying"), "it has not ended, it is carrying"),
        (lambda f: f["tables"]["handovers"].pop(), "was delivered with the receipts ['load']"),
        (lambda f: f["tables"]["handovers"].append(f["tables"]["handovers"][0]), "['load', 'load', 'receive']"),
        (
            lambda f: f["tables"]["handovers"][1].update(evidence="claimed", problem="no_proof"),
            "a hand-over (receive) of order o1 goes by claimed: no_proof",
        ),
        (
            lambda f: f["tables"]["refused_receipts"].append({"order_id": "o1", "problem": "unknown_code"}),
            "a receipt of order o1 was refused",
        ),
        (lambda f: f["tables"]["notices"].append(f["tables"]["notices"][0]), "the sender was told accepted 2 times"),
        (lambda f: f["tables"]["notices"].pop(), "recipient delivered was not told"),
        (lambda f: f["tables"]["notices"][0].update(person_id="eve"), "the stranger was told accepted"),
        (lambda f: f["tables"]["notices"][0].update(routed_at=None), "notice 0 was given to no channel"),
        (lambda f: f["tables"]["outbox"][0].update(sent_at=None), "mail mail.0 was never sent"),
        (lambda f: f["mail_ids"].pop(), "mail mail.5 counts as sent, and no mail server has it"),
        (lambda f: f["mail_ids"].append("<mail.9@x>"), "mail mail.9 was sent, and nothing here wished it"),
        (lambda f: f["tables"]["outbox"][0].update(notice_id=1), "notice 1 was mailed under 2 keys"),
        (lambda f: f["tables"]["robot_messages"].pop(), "r1: message 2 was acknowledged and is lost"),
        (lambda f: f["said"]["r1"].pop(2), "r1: message 2 was never said"),
        (lambda f: f["tables"]["robot_messages"].append(f["tables"]["robot_messages"][0]), "numbers were taken twice"),
        (lambda f: f["said"]["r1"].update({1: {"n": 9}}), "r1: message 1 was kept as another"),
        (lambda f: f["tables"]["server_outbox"][0].update(acked_at=None), "r1 was never told mission 1"),
    ],
)
def test_whatever_is_lost_doubled_or_contradicts_itself_is_named(damage: Damage, named: str) -> None:
    facts = deepcopy(in_order())
    damage(facts)
    assert any(named in sentence for sentence in judged(Facts(**facts))), judged(Facts(**facts))
