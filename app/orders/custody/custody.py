"""The chain of custody: holders of the mail without gaps, and how each hand-over was confirmed.

It derives from the receipts of robots alone (and from a dispatcher's report, for mail fetched by hand), never from
the order's state. Each hand-over ends one link and begins the next, so that at any time exactly one holds the mail.
What a robot claims of mail that it says is out stands beside the chain until it is settled, and ends no link.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from types import MappingProxyType
from typing import Final

from app.models import Evidence, Handover, Order, Settled
from app.orders.custody.codes import Holder
from app.orders.custody.unproven import counts, is_open_claim_of_handing_out
from protocol.parts import Purpose

SETTLED: Final = "settled"
"""Claimed, and found true since: by who was asked, or by what followed."""


@dataclass(frozen=True)
class CustodyLink:
    """One link: who held it (sender, robot, recipient, delegate or mailroom), and until when; None: to this day.

    `name` is the robot's or the delegate's; of the others there is one each.

    `how` tells how they came to have it: code, tap, digits or button by a robot's receipt, `dispatcher` by a
    dispatcher's report, None for the sender's own. `confirmed_by` is whose code, tap or digits it was
    (`confirmed_by_name`: which delegate's), `signed` whether the robot has signed for it. `evidence` says what all that
    goes by, one of `app.models.Evidence` or SETTLED.
    """

    holder: str
    name: str | None
    since: datetime
    until: datetime | None
    how: str | None
    confirmed_by: str | None = None
    signed: bool = False
    confirmed_by_name: str | None = None
    evidence: str | None = None


def custody_of(
    order: Order, handovers: Iterable[Handover], delegates: Mapping[str, str] = MappingProxyType({})
) -> tuple[CustodyLink, ...]:
    """The links of an order's chain, oldest first; `handovers` in the order in which they were written down,
    `delegates` the names of those who took part, by their ids."""
    chain, claims = [CustodyLink(Holder.SENDER, None, order.created_at, None, None)], []
    for one in handovers:
        delegate = delegates.get(one.delegate_id or "")
        last, holder = chain[-1], _holder(order, one, delegate)
        at = max(one.robot_at if _is_plausible(one) else one.at, last.since)
        link = CustodyLink(*holder, at, None, one.how, one.holder, one.signature is not None, delegate, _evidence(one))
        if one.evidence == Evidence.CLAIMED:
            link = replace(link, confirmed_by=None, confirmed_by_name=None)
        if is_open_claim_of_handing_out(one):
            claims.append(link)
        elif counts(one) and holder != (last.holder, last.name):
            # Else the same pair of hands again: a robot that lost its memory tells what is known.
            chain[-1] = replace(last, until=at)
            chain.append(link)
    return (*chain, *claims)


def _evidence(one: Handover) -> str:
    return SETTLED if one.settled == Settled.TRUE else one.evidence


def _holder(order: Order, one: Handover, delegate: str | None) -> tuple[str, str | None]:
    """Return the holder after this hand-over, and a robot's or delegate's name."""
    if one.purpose == Purpose.LOAD:
        return ("robot", one.robot)
    if one.holder is not None:
        return (one.holder, delegate)
    if one.purpose == Purpose.RECEIVE:
        return (Holder.RECIPIENT, None)
    return (Holder.SENDER if one.post == order.from_post else Holder.MAILROOM, None)


def _is_plausible(one: Handover) -> bool:
    """Return whether the robot's own time of it can be shown: nothing is reported before it has happened."""
    return one.robot_at <= one.at
