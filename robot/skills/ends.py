"""The ends of each long action: its time limit, what it gives, and by which names it fails. A test holds this against
the skills themselves; docs and plans of the agent go by it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Ends:
    """One row. The limit is the default; `on_timeout` is the reason when it has passed."""

    skill: str
    limit_s: float
    on_timeout: str
    done: str
    reasons: Mapping[str, str]


ENDS: Final = (
    Ends(
        "follow_line",
        600.0,
        "timeout",
        "the post reached",
        {
            "line_lost": "no line, after the whole ladder of find_line, or three searches within half a metre",
            "post_missed": "the corridor is over, no marker was read, and which post it is is not known",
            "blocked": "three bumps",
            "docked": "it stands in a dock",
            "must_wait": "it stands before a post with bays and has been granted no way on from there",
            "timeout": "no post in time",
        },
    ),
    Ends(
        "turn",
        30.0,
        "timeout",
        "the line is under the centre diode",
        {"line_lost": "none within 40° of where the map says", "timeout": "it did not get round"},
    ),
    Ends(
        "find_line",
        180.0,
        "line_lost",
        "the line is under the diodes, the way it was driven before",
        {"line_lost": "coast, arc, back, sweep and spiral have not met it"},
    ),
    Ends("dock", 300.0, "no_dock", "3 s of charging", {"no_dock": "three tries"}),
    Ends(
        "undock",
        60.0,
        "timeout",
        "on the line, looking away from the dock",
        {
            "not_docked": "it is on no dock",
            "line_lost": "no line within half a metre behind the dock",
            "timeout": "it did not get away",
        },
    ),
    Ends(
        "wait_handover",
        600.0,
        "no_one_came",
        "the code that was shown, none for Spot pressed twice",
        {"no_one_came": "no valid code was shown in time"},
    ),
    Ends("say", 5.0, "timeout", "at once", {"timeout": "never: the base plays by itself"}),
)

OF_ANY: Final = {
    "busy": "another motion has the wheels",
    "cancelled": "the action was withdrawn",
    "broken": "a mistake in the skill; the log has it",
}
"""Any of them may also end so, and a motion by the name of the fault that took the wheels from the firmware."""
