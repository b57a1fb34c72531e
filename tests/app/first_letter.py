"""Rows of every table as the service of schema 0001 left them: an order delivered, one under way, one in the queue.

Written for that schema's own tables, whatever today's classes say. Times are naive UTC, as they are stored.
"""

from datetime import datetime, timedelta
from typing import Any, Final

MORNING: Final = datetime(2026, 1, 5, 9, 0)  # noqa: DTZ001  # as the database keeps it
A_WEEK: Final = timedelta(days=7)


def at(minute: float) -> datetime:
    return MORNING + timedelta(minutes=minute)


def _order(order_id: str, state: str, version: int, **known: Any) -> dict[str, Any]:
    common = {
        "id": order_id,
        "state": state,
        "version": version,
        "sender_id": "ada",
        "recipient_id": "bob",
        "from_post": "post1",
        "to_post": "post4",
        "created_at": at(0),
        "updated_at": at(version),
        "codes_expire_at": at(0) + A_WEEK,
        "window_from": at(10),
        "window_to": at(20),
        "window_assumed": True,
        "robot": "r1",
    }
    return {**common, **known}


def _events(order_id: str, *states: str) -> list[dict[str, Any]]:
    who = [{"by": "sender", "person_id": "ada"}, {"by": "dispatcher", "robot": "r1"}]
    robot = {"by": "robot", "robot": "r1", "post": "post1", "robot_at": at(1.5)}
    rows = [{"order_id": order_id, "seq": n, "state": state, "at": at(n)} for n, state in enumerate(states, start=1)]
    return [{**row, **(who[n] if n < 2 else robot)} for n, row in enumerate(rows)]


def _notice(number: int, order_id: str, kind: str, person_id: str) -> dict[str, Any]:
    facts = {"sender": "Ada King", "from": "Post 1"}
    return {"id": number, "order_id": order_id, "kind": kind, "person_id": person_id, "at": at(number), "facts": facts}


def _sending(number: int, notice: int, sent: bool) -> dict[str, Any]:
    times = {"created_at": at(notice), "next_try_at": at(notice), "sent_at": at(notice) if sent else None}
    return {"id": number, "key": f"mail.{notice}", "channel": "mail", "notice_id": notice, "tries": int(sent), **times}


DELIVERED: Final = ("queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")

ROWS: Final[dict[str, list[dict[str, Any]]]] = {
    "people": [
        {"id": name, "email": f"{name}@campus.example", "name": name.title(), "language": language, "roles": roles,
         "created_at": at(0)}
        for name, language, roles in (("ada", "en", ["member", "maintainer"]), ("bob", "fr", ["member"]))
    ],
    "robots": [
        {"name": "r1", "enrolled_at": at(0), "server_journal": "s1", "last_seq": 3, "online": True, "heard_at": at(7),
         "software": "0.1.0", "map_version": "1", "post": "post4", "activity": "idle", "battery_ratio": 0.7,
         "charging": False}
    ],
    "sign_in_codes": [
        {"id": 1, "email": "ada@campus.example", "code_hash": "a" * 64, "created_at": at(0), "expires_at": at(10),
         "tries_left": 4, "used_at": at(1)}
    ],
    "alarms": [{"id": 1, "robot": "r1", "name": "bumped", "reason": "something was in the way", "post": "post2",
                "at": at(3), "cleared_at": at(4)}],
    "claims": [{"robot": "r1", "claim_id": "c1", "legs": [{"from": "post1", "to": "post2"}], "at": at(4),
                "granted": True}],
    "grants": [{"id": 1, "robot": "r1", "claim_id": "c1", "corridor": "post1-post2", "from_post": "post1",
                "to_post": "post2", "granted_at": at(4), "cleared_at": at(5)}],
    "missions": [
        {"id": "m1", "robot": "r1", "update_number": 1, "state": "done", "created_at": at(1), "accepted_at": at(1),
         "finished_at": at(7)},
        {"id": "m2", "robot": "r1", "update_number": 1, "state": "active", "created_at": at(8)},
    ],
    "orders": [
        _order("o1", "delivered", 7, description="Keys"),
        _order("o2", "to_sender", 4, cancel_requested_at=at(9), cancel_requested_by="sender"),
        _order("o3", "queued", 1, robot=None, why="Every robot is on its way."),
    ],
    "order_events": [
        *_events("o1", *DELIVERED), *_events("o2", "queued", "assigned", "to_sender"), *_events("o3", "queued")
    ],
    "stops": [
        {"id": f"s{n}", "mission_id": mission, "position": n % 2, "post": post, "action": action, "order_id": order,
         "wait_limit_s": 600.0, "done_at": done}
        for n, (mission, post, action, order, done) in enumerate((
            ("m1", "post1", "load", "o1", at(5)), ("m1", "post4", "receive", "o1", at(7)),
            ("m2", "post1", "load", "o2", None), ("m2", "post4", "receive", "o2", None)))
    ],
    "handovers": [
        {"id": n, "order_id": "o1", "stop_id": f"s{n}", "purpose": purpose, "robot": "r1", "post": "post1",
         "code_sha256": "b" * 64, "robot_at": at(5), "at": at(5)}
        for n, purpose in enumerate(("load", "receive"))
    ],
    "notices": [
        _notice(1, "o1", "accepted", "ada"), _notice(2, "o1", "delivered", "bob"), _notice(3, "o3", "accepted", "ada")
    ],
    "outbox": [_sending(1, 1, True), _sending(2, 2, True), _sending(3, 3, False)],
    "idempotency_keys": [{"person_id": "ada", "key": "k1", "body_hash": "c" * 64, "status": 201,
                          "headers": {"Location": "/api/v1/orders/o1"}, "answer": {"id": "o1"}, "created_at": at(0)}],
    "robot_tokens": [{"prefix": "01234567", "secret_hash": "d" * 64, "robot": "r1", "created_at": at(0),
                      "used_at": at(1)}],
    "robot_journals": [{"robot": "r1", "journal": "j1", "received_seq": 2, "first_seen_at": at(0)}],
    "robot_messages": [
        {"robot": "r1", "journal": "j1", "seq": n, "type": "event", "body": {"n": n}, "sent_at": at(n),
         "received_at": at(n)} for n in (1, 2)
    ],
    "server_outbox": [
        {"robot": "r1", "seq": n, "type": kind, "body": {"order_id": "o2"}, "created_at": at(8),
         "acked_at": at(8) if n == 1 else None} for n, kind in ((1, "verifiers"), (2, "mission"), (3, "cancel"))
    ],
    "sessions": [{"id": 1, "token_hash": "e" * 64, "person_id": "ada", "created_at": at(0),
                  "expires_at": at(0) + A_WEEK}],
}  # fmt: skip
