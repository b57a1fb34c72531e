"""The estimate of an order's arrival, as every page and every notice has it."""

from datetime import datetime
from typing import Final

from pydantic import BaseModel, ConfigDict, Field

from app.core.texts.reasons import Words, words_of
from app.models import Order, OrderState, RobotRow
from app.orders.transitions import ROBOT_COMING, TURNED_BACK
from app.orders.views.reasons import is_waiting, why_no_time

STILL_TO_COME: Final = ROBOT_COMING | {OrderState.QUEUED, OrderState.CARRYING}


class EstimateView(BaseModel):
    """The arrival at the recipient's that is expected now.

    `from` and `to` are null while no time is known: an interval that is over is never given. `made_at`: when it was
    worked out. `assumed`: by the map alone, nothing was measured yet. `reason` (and `reason_words`, as a text of the
    catalogue) is what the order waits for; there is always one where no time is known. `promised_to` is the end of the
    window that its people were told; `late`: that is over, or a delay was told of.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True, serialize_by_alias=True)

    from_: datetime | None = Field(alias="from")
    to: datetime | None
    made_at: datetime | None
    assumed: bool
    reason: str | None
    reason_words: Words | None
    promised_to: datetime | None
    late: bool

    def without_own_words(self) -> "EstimateView":
        """The same without a reason that the catalogue does not have: it may be anybody's own words."""
        return self if self.reason_words else self.model_copy(update={"reason": None})


def expected_of(order: Order, now: datetime) -> tuple[datetime, datetime] | None:
    """The interval in which the robot should come to the recipient; None if that is not known."""
    begins_at, ends_at = order.expected_from, order.expected_to
    if order.state not in STILL_TO_COME or begins_at is None or ends_at is None or ends_at <= now:
        return None
    return begins_at, ends_at


def estimate_view(
    order: Order, robot: RobotRow | None, why: str | None, why_words: Words | None, now: datetime
) -> EstimateView | None:
    """None where no arrival is ahead: the robot is there, the mail goes back, or the order has ended. `why_words`: None
    for what a person has typed, whatever it looks like."""
    is_stopped = order.state is OrderState.ATTENTION and order.state_before_attention not in TURNED_BACK
    if order.state not in STILL_TO_COME and not is_stopped:
        return None
    expected = expected_of(order, now)
    reason = why if order.why or robot is None or is_waiting(robot) else None
    if reason is None and expected is None:
        reason = why_no_time(order, robot, now)
        why_words = words_of(reason)
    begins_at, ends_at = expected or (None, None)
    return EstimateView(
        from_=begins_at,
        to=ends_at,
        made_at=order.estimated_at,
        assumed=order.window_assumed,
        reason=reason,
        reason_words=why_words if reason else None,
        promised_to=order.window_to,
        late=is_late(order, now),
    )


def is_late(order: Order, now: datetime) -> bool:
    return order.delayed_at is not None or (order.window_to is not None and order.window_to < now)
