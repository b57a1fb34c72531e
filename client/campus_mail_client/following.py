"""Changes of an order that a program follows."""

from dataclasses import dataclass
from typing import Any

from campus_mail_client.models import OrderView

ENDED = frozenset({"delivered", "returned", "held", "expired", "cancelled"})
ASK = frozenset({"connected", "resync"})


@dataclass(frozen=True)
class Change:
    """Something that happened: `event` says what `data` is (`order`: an order as the API shows it, and so on)."""

    event: str
    data: dict[str, Any]


class OrderWatch:
    """Remembers what was shown of one order, so that nothing is shown twice or after what came later."""

    def __init__(self, order_id: str) -> None:
        self._order_id = order_id
        self._shown: OrderView | None = None

    def must_ask(self, change: Change) -> bool:
        """Tell if the order may have changed without this stream saying how."""
        return change.event in ASK

    def order_in(self, change: Change) -> OrderView | None:
        """The order, if it is what changed."""
        is_it = change.event == "order" and change.data.get("id") == self._order_id
        return OrderView.model_validate(change.data) if is_it else None

    def is_news(self, order: OrderView) -> bool:
        """Tell if it says what was not shown before; an older version says nothing."""
        shown = self._shown
        if shown is not None and (order.version < shown.version or order == shown):
            return False
        self._shown = order
        return True
