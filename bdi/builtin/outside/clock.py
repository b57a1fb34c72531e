"""The clock that the agent is given, seconds that never go back: `.time`, `.date`, `.nano_time`.

Read as seconds since 1970 (UTC) it gives the time of day and the date.
"""

from datetime import UTC, datetime

from bdi.builtin.kinds import OUT, optional
from bdi.builtin.table import Answer, internal_action
from bdi.language.terms import Term, number
from bdi.language.unify import unify
from bdi.model.mind import Mind


def _all_unify(mind: Mind, wanted: tuple[Term | None, ...], values: tuple[int, ...]) -> bool:
    pairs = zip(wanted, values, strict=True)
    return all(each is None or unify(each, value, mind.logic.trail) for each, value in pairs)


@internal_action("time", OUT, OUT, OUT, optional(OUT))
def clock(mind: Mind, hours: Term, minutes: Term, seconds: Term, milliseconds: Term | None = None) -> Answer:
    """Hours, minutes, seconds (and milliseconds) of the day."""
    whole = int(mind.now)
    parts = (whole // 3600 % 24, whole // 60 % 60, whole % 60, int(mind.now * 1000) % 1000)
    return _all_unify(mind, (hours, minutes, seconds, milliseconds), parts)


@internal_action("date", OUT, OUT, OUT)
def date(mind: Mind, year: Term, month: Term, day: Term) -> Answer:
    try:
        today = datetime.fromtimestamp(mind.now, UTC)
    except (ValueError, OverflowError, OSError):  # no year that there is
        return False
    return _all_unify(mind, (year, month, day), (today.year, today.month, today.day))


@internal_action("nano_time", OUT)
def nano_time(mind: Mind, result: Term) -> Answer:
    return unify(result, number(int(mind.now * 1e9)), mind.logic.trail)
