"""Refusals of orders.

Unprocessable      ├── UnknownPost
                   ├── SamePost
                   ├── NoWay
                   ├── UnknownRecipient
                   ├── UnknownSender
                   ├── UnknownRobotWanted
                   └── KeyReused
Forbidden          └── ForDispatchers
NotFound           ├── UnknownOrder
                   ├── UnknownStandingOrder
                   └── NoCodeForYou
Conflict           ├── StillRunning
                   ├── TransitionRefused
                   ├── NotCancellable
                   ├── NotRecallable
                   ├── NotWaiting
                   ├── WaitedLongEnough
                   ├── NotReassignable
                   ├── NothingToResume
                   ├── NothingClaimed
                   ├── NothingToPassOn
                   └── StandingOrderEnded
PreconditionFailed └── OrderChanged
"""

from app.core.errors import Conflict, Forbidden, NotFound, PreconditionFailed, Unprocessable


class UnknownPost(Unprocessable):
    """The campus map has no such post; the sentence offers the nearest spelling."""

    code = "unknown_post"


class SamePost(Unprocessable):
    """From and to are the same post: nothing to carry."""

    code = "same_post"


class NoWay(Unprocessable):
    """Both posts exist, but no corridors join them."""

    code = "no_way"


class UnknownSender(Unprocessable):
    """No person with the address of `on_behalf_of` is known, and its domain is not the campus's."""

    code = "unknown_sender"


class ForDispatchers(Forbidden):
    """A member ordered for another person, or with high priority."""

    code = "for_dispatchers"


class UnknownStandingOrder(NotFound):
    """No such standing order, or not one of this person's."""

    code = "unknown_standing_order"


class NothingToPassOn(Conflict):
    """Mail changes robots while one is bringing it to its recipient, not before or after."""

    code = "nothing_to_pass_on"


class StandingOrderEnded(Conflict):
    """A standing order that has ended does not come round again: make a new one."""

    code = "standing_order_ended"


class UnknownRobotWanted(Unprocessable):
    """The robot that is to fetch the order is not enrolled."""

    code = "unknown_robot"


class UnknownRecipient(Unprocessable):
    """No person with this address is known, and its domain is not the campus's."""

    code = "unknown_recipient"


class KeyReused(Unprocessable):
    """The Idempotency-Key was used for another body in the last 24 hours."""

    code = "idempotency_key_reused"


class UnknownOrder(NotFound):
    """No such order, or not one of this person's."""

    code = "unknown_order"


class NoCodeForYou(NotFound):
    """It is not this person's turn to show a code."""

    code = "no_code"


class StillRunning(Conflict):
    """The first request with this Idempotency-Key has not ended yet."""

    code = "still_running"


class TransitionRefused(Conflict):
    """The table of transitions does not allow this step, or not on this word."""

    code = "transition_refused"


class NotCancellable(Conflict):
    """Ended already, or waiting for a dispatcher."""

    code = "not_cancellable"


class NotRecallable(Conflict):
    """There is no mail aboard that could turn back, or it is not this person's to call back."""

    code = "not_recallable"


class NotWaiting(Conflict):
    """No robot is waiting, or not for this person."""

    code = "not_waiting"


class WaitedLongEnough(Conflict):
    """The robot's other passengers are waiting, too."""

    code = "waited_long_enough"


class NotReassignable(Conflict):
    """The mail is aboard, or the order has ended."""

    code = "not_reassignable"


class NothingClaimed(Conflict):
    """The robot says that it has this mail still, or nothing: there is no word of it to be believed."""

    code = "nothing_claimed"


class NothingToResume(Conflict):
    """The order's robot has dropped it: there is nothing to go on with."""

    code = "nothing_to_resume"


class OrderChanged(PreconditionFailed):
    """If-Match names an older version of the order."""

    code = "order_changed"
