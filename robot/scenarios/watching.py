"""Continuous checks by the world's truth: no corridor without a grant, and how the time was spent."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from maps import CampusMap
from robot.scenarios.actors.actors import Actor
from robot.scenarios.actors.people import Bystander
from robot.scenarios.actors.stand_in import StandIn
from robot.scenarios.places import corridor_at

NEAR_PERSON_M = 0.6
"""A robot that stands so near to a person in its way waits for them."""


@dataclass
class Times:
    """Seconds of one robot since its first mission, by what they went into; mm by the wheels."""

    drive_s: float = 0.0
    """A skill had the wheels."""
    search_s: float = 0.0
    """Of these: the line was lost and looked for."""
    handover_s: float = 0.0
    """It stood at a post where a person was to come, until they had come."""
    dock_s: float = 0.0
    """It stood in a dock."""
    person_s: float = 0.0
    """It stood before a person in its way."""

    @property
    def stops_s(self) -> float:
        """Standing still for others."""
        return self.handover_s + self.dock_s + self.person_s


@dataclass
class Watch:
    """`tick` ten times a second. `violations` are corridors entered without a grant, each told once."""

    campus: CampusMap
    service: StandIn
    times: dict[str, Times] = field(default_factory=dict)
    violations: list[str] = field(default_factory=list)
    bumps: dict[str, int] = field(default_factory=dict)
    searches: dict[str, int] = field(default_factory=dict)
    _inside: dict[str, str | None] = field(default_factory=dict)
    _last_s: float = 0.0

    def tick(self, actors: Iterable[Actor], present: Iterable[Bystander], now: float) -> None:
        passed_s, self._last_s = now - self._last_s, now
        present = list(present)
        for actor in actors:
            self._look_at_corridor(actor, now)
            view = actor.parts.mind.hands.body.view
            self.bumps[actor.name], self.searches[actor.name] = view.bumps, view.find_line_episodes
            self._count(actor, present, passed_s, now)

    def _look_at_corridor(self, actor: Actor, now: float) -> None:
        pose = actor.body.pose
        corridor = corridor_at(self.campus, pose.x_m, pose.y_m)
        entered, self._inside[actor.name] = corridor != self._inside.get(actor.name), corridor
        if corridor is None or actor.carried or self.service.interlocking.may_be_in(actor.name, corridor):
            return
        told = f"{actor.name} is in {corridor} without a grant"
        if entered or not any(one.startswith(told) for one in self.violations):
            self.violations.append(f"{told} at {now:.1f} s")

    def _count(self, actor: Actor, present: list[Bystander], passed_s: float, now: float) -> None:
        times = self.times.setdefault(actor.name, Times())
        view = actor.parts.mind.hands.body.view
        under_way = actor.parts.mind.actions.under_way
        near = any(one.gap_m(actor) < NEAR_PERSON_M for one in present)
        if actor.body.docked:
            times.dock_s += passed_s
        elif any(action.startswith("wait_handover") for action in under_way):
            times.handover_s += passed_s
        elif near and actor.stands_s(now) > 0:
            times.person_s += passed_s
        elif view.motion is not None:
            times.drive_s += passed_s
            times.search_s += passed_s * view.searching
