"""The contenders: the paper's program with its sensor on the wheel axle or ahead of it, and our own.

All of them drive the same simulated robot on the paper's test track: from the line before post1, a letter from post1 to
post4, and a battery that becomes low on the way, as in section 6.3 of the paper.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.body.errands import Errands
from protocol.clock import Clock
from robot.agent.mind import messages_from_person
from robot.core.config import load_settings
from robot.ops.assembly import Parts, Simulation, assemble

START, SENDER, RECIPIENT, DOCK = "post2:post1", "post1", "post4", "post5"
ON_THE_AXLE_MM = 0.0
# The simulated pack is assumed to be small and its charger strong, so that a charge takes a minute.
PACK = {"battery.simulated_capacity_mah": 1500.0, "battery.simulated_charger_ma": 60_000.0}
SIMULATED_LINE_HZ = 50.0


@dataclass(frozen=True)
class Contender:
    """`program` None is ours. `settings` are dotted keys as in robot.toml."""

    name: str
    title: str
    program: Path | None = None
    settings: dict[str, Any] = field(default_factory=dict)

    def assembled(self, data: Path, clock: Clock, seed: int, *, in_memory: bool, **settings: Any) -> Parts:
        """A robot that has been told what to do; `watchers` of the daemon play the people."""
        asked = {**PACK, "home": DOCK, **self.settings, **settings, "data": data, "mind.program": self.program}
        parts = assemble(load_settings(None, asked), clock, Simulation(START, seed=seed, in_memory=in_memory))
        if self.program:
            goal = f"collectAndDeliverMail({SENDER},{RECIPIENT})"
            parts.mind.inbox.extend(messages_from_person([f"dockStation({DOCK})"], [goal]))
        else:
            parts.daemon.watchers = (Errands(parts, clock, seed, _one_letter()).look,)
        return parts

    def has_collected(self, parts: Parts) -> bool:
        """The paper's program takes it that the mail is aboard once it has been at the sender's post."""
        if self.program:
            return SENDER in parts.navigator.visited
        return bool(parts.mind.hands.missions.held.cargo)

    def has_delivered(self, parts: Parts) -> bool:
        if self.program:
            return parts.mind.is_quiet and parts.navigator.visited[-1:] == [RECIPIENT]
        return parts.mind.hands.missions.held.mission is None and SENDER in parts.navigator.visited


def _one_letter() -> Iterator[tuple[str, str]]:
    yield SENDER, RECIPIENT


def contenders(papers_program: Path | None) -> tuple[Contender, ...]:
    """Ours alone where the paper's program is not at hand."""
    ours = Contender("ours", "our program")
    if papers_program is None:
        return (ours,)
    axle = {"line.lead_mm": ON_THE_AXLE_MM}
    return (
        Contender("paper_axle", "the paper's program, sensor on the axle", papers_program, axle),
        Contender("paper_lead", "the paper's program, sensor 60 mm ahead", papers_program),
        ours,
    )
