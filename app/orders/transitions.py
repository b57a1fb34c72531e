"""Which state of an order may follow which, and on whose word. Whatever is not here is refused by name.

queued → assigned → to_sender → at_sender → carrying → at_recipient → delivered
                                   │            │           └→ returning → at_return → returned | held
                                   └→ expired   └→ (fault, mail aboard) attention
queued | assigned | to_sender | at_sender → cancelled
any fault → attention → (dispatcher) the state it left, or returning
"""

from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from app.tables import OrderState


class By(StrEnum):
    """On whose word. `dispatcher` is a person of that role or the service's own dispatch."""

    SENDER = "sender"
    RECIPIENT = "recipient"
    ROBOT = "robot"
    DISPATCHER = "dispatcher"
    TIMER = "timer"


S = OrderState
SENDER, RECIPIENT, ROBOT, DISPATCHER, TIMER = By.SENDER, By.RECIPIENT, By.ROBOT, By.DISPATCHER, By.TIMER
FAULT: Final = {S.ATTENTION: {ROBOT, DISPATCHER}}

TRANSITIONS: Final[Mapping[OrderState, Mapping[OrderState, set[By]]]] = {
    S.QUEUED: {S.ASSIGNED: {DISPATCHER}, S.CANCELLED: {SENDER, DISPATCHER}},
    # From here on a robot is on its way: a wish to cancel takes effect on its answer.
    S.ASSIGNED: {S.TO_SENDER: {ROBOT}, S.CANCELLED: {ROBOT, DISPATCHER}, **FAULT},
    S.TO_SENDER: {S.AT_SENDER: {ROBOT}, S.CANCELLED: {ROBOT, DISPATCHER}, **FAULT},
    S.AT_SENDER: {S.CARRYING: {ROBOT}, S.EXPIRED: {ROBOT, TIMER}, S.CANCELLED: {ROBOT, DISPATCHER}, **FAULT},
    S.CARRYING: {S.AT_RECIPIENT: {ROBOT}, S.RETURNING: {ROBOT, DISPATCHER}, **FAULT},
    S.AT_RECIPIENT: {S.DELIVERED: {ROBOT}, S.RETURNING: {ROBOT, DISPATCHER, TIMER}, **FAULT},
    S.RETURNING: {S.AT_RETURN: {ROBOT}, **FAULT},
    S.AT_RETURN: {S.RETURNED: {ROBOT}, S.HELD: {ROBOT, DISPATCHER}, **FAULT},
    # Out of attention leads back to the state that was left (see `is_allowed`), or home with what is aboard.
    S.ATTENTION: {S.RETURNING: {DISPATCHER}},
    S.DELIVERED: {},
    S.RETURNED: {},
    S.HELD: {},
    S.EXPIRED: {},
    S.CANCELLED: {},
}

ENDED: Final = frozenset(state for state, following in TRANSITIONS.items() if not following)
MAIL_ABOARD: Final = frozenset({S.CARRYING, S.AT_RECIPIENT, S.RETURNING, S.AT_RETURN})
ROBOT_COMING: Final = frozenset({S.ASSIGNED, S.TO_SENDER, S.AT_SENDER})

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
    """Whether a robot that says `to` speaks of what lies behind the order."""
    here = before_attention or state
    if to in BY_THE_WAY or to in ENDED:
        return False
    return here in ENDED or WAY.index(to) < WAY.index(here)


def is_allowed(state: OrderState, to: OrderState, by: By, before_attention: OrderState | None = None) -> bool:
    """Whether `to` may follow `state` on the word of `by`; `before_attention` is where a fault struck, if one did."""
    if state is S.ATTENTION and to is S.RETURNING:
        return by in TRANSITIONS[state][to] and before_attention in MAIL_ABOARD
    if state is S.ATTENTION:
        return by is DISPATCHER and to is before_attention
    return by in TRANSITIONS[state].get(to, set())
