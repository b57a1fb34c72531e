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
    """A corridor that a robot was let into, at `entered_s`, before a further one, and the bay behind it that it does
    not stop in. `lane` None: it is through, or began there. `at_home`: beside the bays.

    `over_s`: how long it takes over the crossing of the post, which it begins at `arrives_s`. Crossing and bay are its
    own until it is over. 0.0: no robot holds the crossing, and the bay is its own until it is through the next
    corridor."""

    lane: Lane | None
    post: int
    arrives_s: float
    at_home: bool = False
    over_s: float = 0.0
    entered_s: float = -inf

    @property
    def over_by_s(self) -> float:
        return self.arrives_s + self.over_s


@dataclass(frozen=True, slots=True)
class Start:
    """Where a robot is, as far as a schedule goes: it stands at a post, or is in a corridor on its way to it.

    It can leave that post at `ready_s` at the earliest: after its arrival, and after what it has begun to handle there.
    `lane` is the corridor that it is in (None: in none), entered at `entered_s` and left at `arrives_s`. Its bay at the
    post is held since `entered_s`; `at_home`: it stands, or will stand, at its home place and needs no bay.
    `before`: what it holds of the way to that corridor, too. `crosses`: the crossing of the post is
    its own until it is wholly in its bay or home place there.
    """

    post: int
    at_home: bool
    ready_s: float
    entered_s: float
    lane: Lane | None = None
    arrives_s: float = -inf
    before: tuple[Through, ...] = ()
    crosses: bool = False

    @property
    def rests(self) -> bool:
        """It is wholly in a bay or at home."""
        return self.lane is None and not self.crosses

    @property
    def is_on_its_way(self) -> bool:
        """It has a corridor or a crossing before it comes into its last corridor."""
        return any(through.lane is not None or through.over_s for through in self.before)

    def on_the_way(self) -> Iterator["Start"]:
        """Each place before that post as one that it has until it is at the next."""
        next_s = [*(through.arrives_s for through in self.before[1:]), self.arrives_s]
        for through, arrives_s in zip(self.before, next_s, strict=False):
            until_s = through.over_by_s if through.over_s else arrives_s
            yield Start(through.post, through.at_home, until_s, through.entered_s, through.lane, through.arrives_s)

    def crossings(self) -> Iterator[tuple[int, float]]:
        """Each post whose crossing is its own, with the time until which it is expected to be."""
        yield from ((through.post, through.over_by_s) for through in self.before if through.over_s)
        if self.crosses:
            yield self.post, self.ready_s


@dataclass(frozen=True, slots=True)
class Task:
    """A robot with all that it has before it, in order. `home` is the post of its home place; None: no way leads there,
    so that it can only stand in a bay. `weight`: how much it costs to have its goals done a second later."""

    start: Start
    goals: tuple[Goal, ...]
    home: int | None
    weight: float = 1.0


class Leg(NamedTuple):
    """The way through one corridor and the stay after it. Without a lane it is no way: the robot stands there (the
    first leg of a journey), or goes from a bay to its home place at the same post.

    At `enter_s` it begins to cross where it was, at `arrive_s` where it comes to, for `over_s`: then it stands there.
    Where crossings take time, `over_s` 0.0 says that it goes straight on: the next leg begins at `arrive_s`.
    So many `goals` are served in that stay, the last of them done at `ready_s` (with none: it stands).
    """

    lane: Lane | None
    enter_s: float
    arrive_s: float
    post: int
    at_home: bool
    goals: int
    ready_s: float
    over_s: float = 0.0

    @property
    def stands_s(self) -> float:
        return self.arrive_s + self.over_s


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
    over_s = 0.0 if start.lane is None else start.ready_s - start.arrives_s
    return Leg(start.lane, start.entered_s, start.arrives_s, start.post, start.at_home, 0, start.ready_s, over_s)


def staying(start: Start) -> Journey:
    """The journey of one that stays where it is, or where it comes to."""
    return Journey((standing(start),), (), start.ready_s)


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


def goes_aside(journey: Journey) -> bool:
    """Tell if it next makes room: from a bay to its home place at the same post."""
    return len(journey.legs) > 1 and journey.legs[1].lane is None


def without_aside(journey: Journey) -> Journey:
    """The same if it goes into the next corridor right from the bay that it was to make free before."""
    legs = journey.legs
    if not goes_aside(journey) or len(legs) < 3:
        return journey
    stays, aside, *further = legs
    first = stays._replace(goals=stays.goals + aside.goals, ready_s=max(stays.ready_s, aside.ready_s))
    work = len(journey.work) - 1 if len(journey.work) > 1 else 1
    return Journey((first, *further[: work - 1]), tuple(further[work - 1 :]), journey.done_s)
