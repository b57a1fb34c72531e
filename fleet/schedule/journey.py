"""Goals of a robot, its start, and the journey that serves them and leads home."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

from fleet.schedule.network import Lane


class Goal(NamedTuple):
    """A stop: `handling_s` at a post, not begun before `not_before_s`. `key` is the caller's."""

    post: int
    handling_s: float
    not_before_s: float = -inf
    key: str = ""


class Through(NamedTuple):
    """A corridor that a robot was let into together with further ones, and the bay behind it that it does not stop in.
    `lane` None: it is through; the bay is its own until it is through the next one, too. `at_home`: beside the bays."""

    lane: Lane | None
    post: int
    arrives_s: float
    at_home: bool = False


@dataclass(frozen=True, slots=True)
class Start:
    """Where a robot is, as far as a schedule goes: it stands at a post, or is in a corridor on its way to it.

    It can leave that post at `ready_s` at the earliest: after its arrival, and after what it has begun to handle there.
    `lane` is the corridor that it is in (None: in none), entered at `entered_s` and left at `arrives_s`. Its bay at the
    post is held since `entered_s`; `at_home`: it stands, or will stand, at its home place and needs no bay.
    `before`: what it holds of the way to that corridor, since `entered_s`, too.
    """

    post: int
    at_home: bool
    ready_s: float
    entered_s: float
    lane: Lane | None = None
    arrives_s: float = -inf
    before: tuple[Through, ...] = ()

    def on_the_way(self) -> Iterator["Start"]:
        """Each place before that post as one that it has until it is at the next."""
        next_s = [*(through.arrives_s for through in self.before[1:]), self.arrives_s]
        for through, until_s in zip(self.before, next_s, strict=False):
            yield Start(through.post, through.at_home, until_s, self.entered_s, through.lane, through.arrives_s)


@dataclass(frozen=True, slots=True)
class Task:
    """A robot with all that it has before it, in order. `home` is the post of its home place; None: no way leads there,
    so that it can only stand in a bay."""

    start: Start
    goals: tuple[Goal, ...]
    home: int | None


class Leg(NamedTuple):
    """The way through one corridor and the stay after it. Without a lane it is no way: the robot stands there (the
    first leg of a journey), or goes from a bay to its home place at the same post.

    So many `goals` are served in that stay, the last of them done at `ready_s` (with none: the arrival).
    """

    lane: Lane | None
    enter_s: float
    arrive_s: float
    post: int
    at_home: bool
    goals: int
    ready_s: float


@dataclass(frozen=True, slots=True)
class Journey:
    """`work`: to the last goal, and to where the robot may stand for ever without being in the way of anybody's work;
    `way_home`: from there. The first leg is where the robot is now; each further one begins when the stay before it
    ends. `done_s`: when the last goal is served (without goals: when the robot is ready)."""

    work: tuple[Leg, ...]
    way_home: tuple[Leg, ...]
    done_s: float

    @property
    def legs(self) -> tuple[Leg, ...]:
        return self.work + self.way_home


def standing(start: Start) -> Leg:
    """The first leg of whatever it does: where it is."""
    return Leg(start.lane, start.entered_s, start.arrives_s, start.post, start.at_home, 0, start.ready_s)


def stays(legs: Sequence[Leg]) -> Iterator[tuple[Leg, float]]:
    """Each leg with the time at which its stay ends; infinity for the last."""
    for at, leg in enumerate(legs):
        yield leg, legs[at + 1].enter_s if at + 1 < len(legs) else inf


def ready_after(arrive_s: float, goals: Sequence[Goal]) -> float:
    """When a robot that arrives then has served all these goals, one after the other."""
    for goal in goals:
        arrive_s = max(arrive_s, goal.not_before_s) + goal.handling_s
    return arrive_s


def without_first(journey: Journey) -> Journey:
    """Return the rest of the journey when the robot has entered the next corridor."""
    work = journey.work[1:]
    return (
        Journey(work, journey.way_home, journey.done_s)
        if work
        else Journey(journey.way_home[:1], journey.way_home[1:], journey.done_s)
    )
