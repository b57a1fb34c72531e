"""Which order goes first: the one that has waited longest, with a head start for the important ones."""

from datetime import UTC, datetime, timedelta

from app.dispatch.waiting_work import counts_since
from app.models import Priority


def test_priority_is_a_head_start_so_that_no_order_waits_for_ever() -> None:
    nine = datetime(2026, 1, 5, 9, tzinfo=UTC)
    later = nine + timedelta(minutes=29)
    much_later = nine + timedelta(minutes=31)
    assert counts_since(later, Priority.HIGH) < counts_since(nine, Priority.NORMAL)
    assert counts_since(much_later, Priority.HIGH) > counts_since(nine, Priority.NORMAL)
    assert counts_since(nine, Priority.LOW) > counts_since(later, Priority.NORMAL)
