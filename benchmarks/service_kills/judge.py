"""Compares what people and robots were promised with what the service has kept and told. Pure: it reads `Facts` alone.

Each rule is a function that yields a sentence for everything that is wrong.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

from app.models import Evidence, OrderState
from app.orders.transitions import ENDED, By, is_allowed

Row = Mapping[str, Any]
ALWAYS_TOLD: Final = {
    ("sender", "accepted"),
    ("sender", "robot_here"),
    ("recipient", "on_its_way"),
    ("recipient", "robot_here_for_you"),
    ("sender", "delivered"),
    ("recipient", "delivered"),
}
"""Of every order that was delivered; more than that at most once each."""


@dataclass(frozen=True)
class Facts:
    """`tables`: rows by table; `acknowledged`: order ids by key; `said`: each robot's messages, as bodies by number.

    `mail_ids`: the Message-ID of every notice's mail, as often as it was accepted.
    """

    tables: Mapping[str, Sequence[Row]]
    acknowledged: Mapping[str, str]
    said: Mapping[str, Mapping[int, Row]]
    mail_ids: Sequence[str]


def judged(facts: Facts) -> list[str]:
    """Everything that is wrong, as sentences."""
    return [sentence for rule in RULES for sentence in rule(facts)]


def mails_repeated(facts: Facts) -> int:
    """Sendings that were repeated under the same Message-ID, by which mail programs know them: no fault."""
    return len(facts.mail_ids) - len(set(facts.mail_ids))


def _orders(facts: Facts) -> Iterator[str]:
    stored = {row["id"] for row in facts.tables["orders"]}
    promised = Counter(facts.acknowledged.values())
    for key, order_id in facts.acknowledged.items():
        if order_id not in stored:
            yield f"order {order_id} was acknowledged to {key} and is lost"
    yield from (f"order {order_id} was the answer to {count} keys" for order_id, count in promised.items() if count > 1)
    yield from (f"order {order_id} is there, and it was not reported: a double" for order_id in stored - set(promised))


def _lives(facts: Facts) -> Iterator[str]:
    events = _by(facts.tables["order_events"], "order_id")
    for order in facts.tables["orders"]:
        life = sorted(events.get(order["id"], []), key=lambda event: event["seq"])
        yield from (f"order {order['id']}: {sentence}" for sentence in _life(order, life))


def _life(order: Row, life: list[Row]) -> Iterator[str]:
    if not life or life[0]["seq"] != 1 or life[0]["state"] != OrderState.QUEUED:
        yield "its life does not begin with the queue"
        return
    if OrderState(order["state"]) not in ENDED:
        yield f"it has not ended, it is {order['state']}"
    if life[-1]["state"] != order["state"]:
        yield f"it is {order['state']}, and its last event says {life[-1]['state']}"
    moves = [event for event in life if event["kind"] == "moved"]
    for before, after in pairwise(moves):
        if not is_allowed(OrderState(before["state"]), OrderState(after["state"]), By(after["by"])):
            yield f"{after['state']} followed {before['state']} on the word of {after['by']}"


def _custody(facts: Facts) -> Iterator[str]:
    receipts = _by(facts.tables["handovers"], "order_id")
    for order in facts.tables["orders"]:
        if order["state"] == OrderState.DELIVERED:
            purposes = sorted(row["purpose"] for row in receipts.get(order["id"], []))
            if purposes != ["load", "receive"]:
                yield f"order {order['id']} was delivered with the receipts {purposes}"
    for row in facts.tables["handovers"]:
        if row["evidence"] != Evidence.PROOF:
            why = f"{row['evidence']}: {row['problem']}"
            yield f"a hand-over ({row['purpose']}) of order {row['order_id']} goes by {why}"
    yield from (
        f"a receipt of order {row['order_id']} was refused: {row['problem']}"
        for row in facts.tables["refused_receipts"]
    )


def _notices(facts: Facts) -> Iterator[str]:
    told = _by(facts.tables["notices"], "order_id")
    for order in facts.tables["orders"]:
        people = {order["sender_id"]: "sender", order["recipient_id"]: "recipient"}
        kinds = Counter((people.get(row["person_id"], "stranger"), row["kind"]) for row in told.get(order["id"], []))
        for (who, kind), count in kinds.items():
            if count > 1 or who == "stranger":
                yield f"order {order['id']}: the {who} was told {kind} {count} times"
        if order["state"] == OrderState.DELIVERED:
            missing = sorted(f"{who} {kind}" for who, kind in ALWAYS_TOLD - set(kinds))
            yield from (f"order {order['id']}: {one} was not told" for one in missing)


def _sendings(facts: Facts) -> Iterator[str]:
    yield from (
        f"notice {row['id']} was given to no channel" for row in facts.tables["notices"] if not row["routed_at"]
    )
    sendings = [row for row in facts.tables["outbox"] if row["channel"] == "mail"]
    yield from (f"mail {row['key']} was never sent: {row['problem']}" for row in sendings if not row["sent_at"])
    accepted = {mail_id.strip("<>").rpartition("@")[0] for mail_id in facts.mail_ids}
    wanted = {row["key"] for row in sendings}
    yield from (f"mail {key} counts as sent, and no mail server has it" for key in sorted(wanted - accepted))
    yield from (f"mail {key} was sent, and nothing here wished it" for key in sorted(accepted - wanted))
    per_notice = Counter(row["notice_id"] for row in sendings)
    yield from (f"notice {notice} was mailed under {n} keys" for notice, n in per_notice.items() if n > 1)


def _robots(facts: Facts) -> Iterator[str]:
    kept = _by(facts.tables["robot_messages"], "robot")
    for robot, said in facts.said.items():
        taken = {row["seq"]: row["body"] for row in kept.get(robot, [])}
        if len(taken) != len(kept.get(robot, [])):
            yield f"{robot}: numbers were taken twice"
        yield from (f"{robot}: message {seq} was acknowledged and is lost" for seq in sorted(set(said) - set(taken)))
        yield from (f"{robot}: message {seq} was never said" for seq in sorted(set(taken) - set(said)))
        differing = [seq for seq in said if seq in taken and taken[seq] != said[seq]]
        yield from (f"{robot}: message {seq} was kept as another" for seq in differing)
    owed = [row for row in facts.tables["server_outbox"] if not row["acked_at"]]
    yield from (f"{row['robot']} was never told {row['type']} {row['seq']}" for row in owed)


def _by(rows: Sequence[Row], column: str) -> dict[Any, list[Row]]:
    sorted_rows: dict[Any, list[Row]] = defaultdict(list)
    for row in rows:
        sorted_rows[row[column]].append(row)
    return sorted_rows


RULES: Final[tuple[Callable[[Facts], Iterator[str]], ...]] = (
    _orders, _lives, _custody, _notices, _sendings, _robots,
)  # fmt: skip
