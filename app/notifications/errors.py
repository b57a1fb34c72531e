"""Refusals about notices.

Unprocessable ├── MutedEverywhere
              └── BadSubscription
NotFound      ├── UnknownDevice
              ├── NoWebhook
              ├── UnknownDelivery
              └── NotInSpool
Conflict      └── SentAlready
"""

from app.core.errors import Conflict, NotFound, Unprocessable


class MutedEverywhere(Unprocessable):
    """A robot waits with a person's mail: one channel at least has to be left for that."""

    code = "muted_everywhere"


class BadSubscription(Unprocessable):
    """The keys are not those of a browser's push subscription."""

    code = "bad_subscription"


class UnknownDevice(NotFound):
    """No such device, or not one of this person's."""

    code = "unknown_device"


class NoWebhook(NotFound):
    """This person has no webhook."""

    code = "no_webhook"


class UnknownDelivery(NotFound):
    """Nothing in the outbox has this number."""

    code = "unknown_sending"


class NotInSpool(NotFound):
    """There is no such mail in the spool."""

    code = "not_in_spool"


class SentAlready(Conflict):
    """It has gone out: sending it again would notify a person twice."""

    code = "sent_already"
