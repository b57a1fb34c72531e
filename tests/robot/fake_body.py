"""A body that does what a test tells it, behind the same door as the drive loop (`skills.interfaces.Body`)."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from robot.drivers.interfaces import BaseState, ChargingState, Odometry, Sighting
from robot.skills.interfaces import Done, Failed, JobEnd, Outcome, Skill, View


@dataclass
class FakeBody:
    """Keeps what was started. `end(name, outcome)` ends the oldest running skill of that name."""

    view: View = field(default_factory=View)
    running: dict[int, Skill] = field(default_factory=dict)
    started: list[str] = field(default_factory=list)
    cancelled: list[str] = field(default_factory=list)
    heard_at_s: float | None = None
    online: bool | None = None
    at_start: Callable[[Skill], None] = lambda _: None
    """Told of each skill when it begins."""
    _ends: list[JobEnd] = field(default_factory=list)
    _numbers: int = 0

    def start(self, skill: Skill, now: float) -> int:
        self._numbers += 1
        if skill.moves and any(other.moves for other in self.running.values()):
            self._ends.append(JobEnd(self._numbers, skill.name, Failed("busy"), now))
            return self._numbers
        self.at_start(skill)
        self.running[self._numbers] = skill
        self.started.append(skill.name)
        return self._numbers

    def cancel(self, job: int) -> None:
        skill = self.running.pop(job, None)
        if skill:
            self.cancelled.append(skill.name)
            self._ends.append(JobEnd(job, skill.name, Failed("cancelled"), self.view.at_s))

    def end(self, name: str, outcome: Outcome | None = None) -> None:
        job = next(job for job, skill in self.running.items() if skill.name == name)
        del self.running[job]
        self._ends.append(JobEnd(job, name, outcome or Done(), self.view.at_s))

    def finished(self) -> tuple[JobEnd, ...]:
        ends, self._ends = tuple(self._ends), []
        return ends

    def heartbeat(self, now: float) -> None:
        self.heard_at_s = now

    def emergency_stop(self) -> None:
        self.view = replace(self.view, faults=self.view.faults | {"emergency_stop"})

    def rearm(self) -> None:
        self.view = replace(self.view, faults=self.view.faults - {"emergency_stop"})

    def link(self, online: bool) -> None:
        self.online = online

    # What a test lets it see.

    def passes_time(self, now: float) -> None:
        """A frame of everything has just arrived."""
        base = self.view.base or BaseState(at_s=now, charge_mah=2000, capacity_mah=2696)
        self.view = replace(self.view, at_s=now, base=replace(base, at_s=now))

    def battery(self, ratio: float, docked: bool = False, state: ChargingState = ChargingState.NOT_CHARGING) -> None:
        base = self.view.base or BaseState(at_s=self.view.at_s)
        charge_mah = round(1000 * ratio)
        new = replace(base, charge_mah=charge_mah, capacity_mah=1000, home_base=docked, charging_state=state)
        self.view = replace(self.view, base=new)

    def counts(self, left: int, right: int) -> None:
        """The base has counted so far, whatever the odometry of the daemon says."""
        base = self.view.base or BaseState(at_s=self.view.at_s)
        self.view = replace(self.view, base=replace(base, left_count=left, right_count=right))

    def rolls(self, distance_mm: float) -> None:
        old = self.view.odometry
        moved = replace(old, ahead_mm=old.ahead_mm + distance_mm, travelled_mm=old.travelled_mm + abs(distance_mm))
        self.view = replace(self.view, odometry=moved)

    def turns(self, by_rad: float) -> None:
        old = self.view.odometry
        turned = Odometry(
            **{
                **{name: getattr(old, name) for name in old.__dataclass_fields__},
                "heading_rad": old.heading_rad + by_rad,
                "spot_turn_rad": old.spot_turn_rad + by_rad,
            }
        )
        self.view = replace(self.view, odometry=turned, motion=None)

    def follows_line(self, bending_rad: float = 0.0) -> None:
        """A follower has the wheels; the line bends (left positive)."""
        old = self.view.odometry
        odometry = replace(old, heading_rad=old.heading_rad + bending_rad)
        self.view = replace(self.view, odometry=odometry, motion="follow_line")

    def does(self, motion: str) -> None:
        """A skill of this name has the wheels."""
        self.view = replace(self.view, motion=motion)

    def searched(self) -> None:
        """It has lost the line and found it again."""
        self.view = replace(self.view, find_line_episodes=self.view.find_line_episodes + 1)

    def has(self, *faults: str) -> None:
        self.view = replace(self.view, faults=frozenset(faults))

    def sees(self, post: str) -> None:
        """The marker of a post abreast of the camera: 300 mm before the post."""
        sighting = Sighting(post, self.view.at_s, 0.0, 350.0)
        self.view = replace(self.view, post=sighting, post_odometry=self.view.odometry)

    def drives_to(self, post: str) -> None:
        """Along the line to the next post, as follow_line does."""
        self.rolls(1700.0)
        self.sees(post)
        self.rolls(300.0)
