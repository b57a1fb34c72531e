"""Transitions between the states of an order, and who may cause them. All others are refused.

queued → assigned → to_sender → at_sender → carrying → at_recipient → delivered
   │                               │            └───────────┴→ returning → at_return → returned | held | delivered
   └→ expired                      └→ expired                            └→ delivered (taken after all)
queued | assigned | to_sender | at_sender → cancelled
assigned | to_sender | at_sender → queued (the robot was told to let go)
a fault → attention → the state it left
                    → queued | cancelled (nothing aboard), returning | held (mail aboard), by a dispatcher
                    → delivered | returned (mail that its robot says is out, and a dispatcher has asked)
carrying | at_recipient | attention → queued (passed on: the mailroom has it, another robot carries it further)
  and what was passed on ends held, where another order would be cancelled or expire
"""

from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from app.models import OrderState


class By(StrEnum):
    """Actors. `dispatcher` is a person of that role or the service's own dispatch."""

    SENDER = "sender"
    RECIPIENT = "recipient"
    ROBOT = "robot"
    DISPATCHER = "dispatcher"
    TIMER = "timer"


S = OrderState
SENDER, RECIPIENT, ROBOT, DISPATCHER, TIMER = By.SENDER, By.RECIPIENT, By.ROBOT, By.DISPATCHER, By.TIMER
FAULT: Final = {S.ATTENTION: {ROBOT, DISPATCHER}}
LET_GO: Final = {S.QUEUED: {ROBOT}, S.CANCELLED: {ROBOT, DISPATCHER}, S.HELD: {ROBOT, DISPATCHER}}
"""From the moment a robot is on its way a request takes effect when it confirms: it drops the order."""
PASSED_ON: Final = {S.QUEUED: {DISPATCHER}}

TRANSITIONS: Final[Mapping[OrderState, Mapping[OrderState, set[By]]]] = {
    S.QUEUED: {
        S.ASSIGNED: {DISPATCHER},
        S.CANCELLED: {SENDER, DISPATCHER},
        S.EXPIRED: {TIMER},
        S.HELD: {SENDER, DISPATCHER, TIMER},
        # A robot out of network had the mail already when a dispatcher gave the order to another.
        S.CARRYING: {ROBOT},
    },
    S.ASSIGNED: {S.TO_SENDER: {ROBOT}, **LET_GO, **FAULT},
    S.TO_SENDER: {S.AT_SENDER: {ROBOT}, **LET_GO, **FAULT},
    S.AT_SENDER: {S.CARRYING: {ROBOT}, S.EXPIRED: {ROBOT, TIMER}, **LET_GO, **FAULT},
    S.CARRYING: {S.AT_RECIPIENT: {ROBOT}, S.RETURNING: {ROBOT, DISPATCHER}, **PASSED_ON, **FAULT},
    S.AT_RECIPIENT: {S.DELIVERED: {ROBOT}, S.RETURNING: {ROBOT, DISPATCHER, TIMER}, **PASSED_ON, **FAULT},
    S.RETURNING: {S.AT_RETURN: {ROBOT}, S.DELIVERED: {ROBOT}, **FAULT},
    # On the way back the recipient's code opens too: what they have taken is delivered.
    S.AT_RETURN: {S.RETURNED: {ROBOT}, S.HELD: {ROBOT, DISPATCHER}, S.DELIVERED: {ROBOT}, **FAULT},
    # Out of attention also leads back to the state that was left; which of these, depends on it (see `is_allowed`).
    S.ATTENTION: {to: {DISPATCHER} for to in (S.RETURNING, S.HELD, S.QUEUED, S.CANCELLED, S.DELIVERED, S.RETURNED)},
    S.DELIVERED: {},
    S.RETURNED: {},
    S.HELD: {},
    S.EXPIRED: {},
    S.CANCELLED: {},
}

ENDED: Final = frozenset(state for state, following in TRANSITIONS.items() if not following)
CARRIED: Final = frozenset({S.CARRYING, S.AT_RECIPIENT})
TURNED_BACK: Final = frozenset({S.RETURNING, S.AT_RETURN})
MAIL_ABOARD: Final = CARRIED | TURNED_BACK
ROBOT_COMING: Final = frozenset({S.ASSIGNED, S.TO_SENDER, S.AT_SENDER})
NOTHING_ABOARD: Final = ROBOT_COMING | {S.QUEUED}
"""What these end in depends on who has the mail: its sender, or, if it was passed on, the mailroom."""
NEVER_LEFT_ITS_SENDER: Final = frozenset({S.CANCELLED, S.EXPIRED})

LOADED: Final = frozenset(S) - {S.QUEUED} - ROBOT_COMING
"""Where mail may have changed hands; of one that is cancelled or expired only if the robot contradicts."""
WAY: Final = (
    S.QUEUED,
    S.ASSIGNED,
    S.TO_SENDER,
    S.AT_SENDER,
    S.CARRYING,
    S.AT_RECIPIENT,
    S.RETURNING,
    S.AT_RETURN,
)
"""The order in which a life goes; what has ended lies behind all of it."""
BY_THE_WAY: Final = frozenset({S.QUEUED, S.CANCELLED, S.EXPIRED, S.ATTENTION})
"""What a robot can say at many points of the way: never old news, but allowed or refused."""


def is_old_news(state: OrderState, to: OrderState, before_attention: OrderState | None = None) -> bool:
    """Return whether a robot that reports `to` reports a state that the order has left behind."""
    here = before_attention or state
    if to in BY_THE_WAY or to in ENDED:
        return False
    return here in ENDED or WAY.index(to) < WAY.index(here)


def is_allowed(
    state: OrderState,
    to: OrderState,
    by: By,
    before_attention: OrderState | None = None,
    *,
    is_passed_on: bool = False,
) -> bool:
    """Return whether `by` may move `state` to `to`; `before_attention` is where a fault struck, if one did.
    `is_passed_on`: one robot has carried it, and another carries it further.

    Back to the state that was left: a dispatcher who has looked says so, or the robot, which has gone on by itself.
    """
    if state in NOTHING_ABOARD and to in (NEVER_LEFT_ITS_SENDER if is_passed_on else {S.HELD}):
        return False
    if state is not S.ATTENTION:
        return by in TRANSITIONS[state].get(to, set())
    if to is before_attention:
        return by in (DISPATCHER, ROBOT)
    return to in _ways_out(before_attention, is_passed_on) and by in TRANSITIONS[state][to]


def _ways_out(before_attention: OrderState | None, is_passed_on: bool) -> set[OrderState]:
    """Out of attention, beside the state that was left."""
    if before_attention in MAIL_ABOARD:
        out = {S.DELIVERED, S.RETURNED, S.HELD}
        return {S.RETURNING, *out, *((S.QUEUED,) if before_attention in CARRIED else ())}
    return {S.QUEUED, S.HELD if is_passed_on else S.CANCELLED}
