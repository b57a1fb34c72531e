"""Corridors that robots found closed. A robot tells of one as a fault, whose sentence names it."""

import re
from typing import Final

from maps import corridor_name

WAY_BLOCKED: Final = "way_blocked"
_TURNED_BACK: Final = re.compile(r"The robot turned back in the corridor from (\w+) to (\w+)\.")


def closed_corridor(fault: str, reason: str) -> str | None:
    """The name that maps have for the corridor of this fault; None if it is about something else."""
    told = _TURNED_BACK.match(reason) if fault == WAY_BLOCKED else None
    return corridor_name(*told.groups()) if told else None
