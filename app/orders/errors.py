"""What an order can be refused for.

Unprocessable      ├── UnknownPost
                   ├── SamePost
                   ├── NoWay
                   ├── UnknownRecipient
                   └── KeyReused
NotFound           ├── UnknownOrder
                   └── NoCodeForYou
Conflict           ├── StillRunning
                   ├── TransitionRefused
                   └── NotCancellable
PreconditionFailed └── OrderChanged
"""

from app.errors import Conflict, NotFound, PreconditionFailed, Unprocessable


class UnknownPost(Unprocessable):
    """The campus map has no such post; the sentence offers the nearest spelling."""

    code = "unknown_post"


class SamePost(Unprocessable):
    """From and to are the same post: nothing to carry."""

    code = "same_post"


class NoWay(Unprocessable):
    """Both posts exist, but no corridors join them."""

    code = "no_way"


class UnknownRecipient(Unprocessable):
    """Nobody with this address is known, and its domain is not the campus's."""

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
    """Ended already, or the mail is aboard (bringing it back is a later issue)."""

    code = "not_cancellable"


class OrderChanged(PreconditionFailed):
    """If-Match names an older version of the order."""

    code = "order_changed"
