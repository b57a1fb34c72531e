"""People: who hand mail over at posts, and who walk or stand in the tunnel.

What a person knows is what they see and hear: a robot that stands at their post, the tune that says yes or no. Mail
moves when a person moves it, and only then; robots are judged by that.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from random import Random
from typing import Final

from maps import CampusMap
from robot.scenarios.actors.actors import Actor
from robot.scenarios.actors.mail import WITH_RECIPIENT, WITH_SENDER, Letter, code
from robot.scenarios.places import stands_at
from robot.scenarios.scenario import PersonAtPost, Stander, Walker
from robot.simulated.obstacles import BUMPER_RADIUS_M

NOTICES_AFTER_S: Final = 1.5
"""A robot that has stood for so long is taken to wait."""
WALKS_UP_S: Final = (1.0, 4.0)
SHOWS_S, RESTS_S = 8.0, 4.0
"""A person holds a code up for so long, then looks what is the matter; others at the post get their turn."""
PRESS_EVERY_S = 0.8
REACHES_IN_S: Final = (1.0, 3.5)
"""From the tune that says yes until the mail is in the box, or out of it."""
DRIVES_OFF_S: Final = 3.0
"""A robot that a person attends to may be pushed and go back a hand's breadth; one that rolls for so long leaves."""
GOES_ROUND_AFTER_S: Final = 4.0
"""A walker who finds a robot in the way stands so long before going round it."""
ROBOT_M, ROUND_IT_M = 0.174, 0.2
IN_FRONT_M: Final = 0.12
"""A robot so near has stopped in front of a person."""


@dataclass
class Handing:
    """One person with one letter at one post. `waits` is for the record: from when until when a robot waited."""

    letter: Letter
    post: str
    person: PersonAtPost
    gives: bool
    random: Random
    wrong_code: str
    came_s: dict[str, float] = field(default_factory=dict)
    """When each robot began to stand there."""
    shows_until_s: float = -math.inf
    rests_until_s: float = -math.inf
    busy_with: str | None = None
    """The robot that the person attends to: one at a time."""
    tried: int = 0
    takes_s: tuple[float, float] = REACHES_IN_S
    """From the robot's yes until the mail is in, or out: at least, at most."""
    reaches_in_s: float | None = None
    """The robot has said yes: when the mail is in, or out."""
    presses: list[float] = field(default_factory=list)
    _delay_s: float = 0.0

    def __post_init__(self) -> None:
        self._delay_s = self.random.uniform(*WALKS_UP_S)
        if self.person.comes == "late":
            self._delay_s += self.person.late_s

    def has_business(self, actor: Actor) -> bool:
        """Return whether this robot may want something of this person."""
        if self.gives and not self.letter.moved:
            return not self.letter.cancelled
        return self.letter.place == actor.name and (not self.gives or self.letter.returning)

    def tick(self, actor: Actor, now: float) -> None:
        """A robot is at the post, or has just left it."""
        meets = self._meets(actor, now)
        if meets and self.busy_with == actor.name and self.reaches_in_s is not None:
            self._reach_in(actor, now)
            return
        if not (meets and self.has_business(actor) and self.person.comes != "never"):
            self._leave(actor)
            return
        if self.busy_with not in (None, actor.name):
            return
        self.busy_with = actor.name
        came_s = self.came_s.setdefault(actor.name, now)
        if now - came_s < self._delay_s:
            return
        if self.shows_until_s > now or self.presses:
            self._attend(actor, now)
        elif now >= self.rests_until_s and not _busy(actor):
            self._begin(actor, now)

    def _meets(self, actor: Actor, now: float) -> bool:
        """It waits at the post, and has not driven off since."""
        if actor.post != self.post:
            return False
        if self.busy_with == actor.name:
            return actor.rolls_s(now) < DRIVES_OFF_S
        return actor.stands_s(now) > NOTICES_AFTER_S

    def _leave(self, actor: Actor) -> None:
        if self.busy_with != actor.name:
            return
        self.busy_with = self.reaches_in_s = None
        self.came_s.pop(actor.name, None)
        if self.shows_until_s > 0 and actor.body.camera.shown == self.shown:
            actor.body.hide_code()
        self.shows_until_s, self.presses = -math.inf, []

    @property
    def shown(self) -> str:
        """The text that is held up this time."""
        wrong = self.person.shows == "wrong" or (self.person.shows == "wrong_first" and self.tried == 1)
        own = self.letter.load_code if self.gives else self.letter.receive_code
        return self.wrong_code if wrong else own

    def _begin(self, actor: Actor, now: float) -> None:
        self.tried += 1
        if self.person.shows == "spot" and self.letter.place == WITH_SENDER:
            self.presses = [now, now + PRESS_EVERY_S, now + SHOWS_S]
        else:
            self.shows_until_s = now + SHOWS_S
            self.rests_until_s = self.shows_until_s + RESTS_S
            actor.body.show_code(self.shown, SHOWS_S)

    def _attend(self, actor: Actor, now: float) -> None:
        while self.presses and now >= self.presses[0]:
            self.presses.pop(0)
            if self.presses:
                actor.body.press("spot")
        if "accepted" in actor.heard:
            self.shows_until_s, self.presses = -math.inf, []
            actor.body.hide_code()
            self.reaches_in_s = now + self.random.uniform(*self.takes_s)
        elif "refused" in actor.heard:
            self.shows_until_s, self.rests_until_s = -math.inf, now + RESTS_S
            actor.body.hide_code()

    def _reach_in(self, actor: Actor, now: float) -> None:
        """It said yes: in with it, or out. Into a box that rolls away no person puts anything."""
        if self.reaches_in_s is None or now < self.reaches_in_s or actor.rolls:
            return
        self.reaches_in_s = None
        taker = WITH_SENDER if self.gives else WITH_RECIPIENT
        self.letter.put(actor.name if self.letter.place == WITH_SENDER else taker, now)


def _busy(actor: Actor) -> bool:
    """Another person is showing something."""
    return actor.body.camera.shown is not None


@dataclass
class Bystander:
    """A person in the way, as `simulated.obstacles.Obstacle`."""

    x_m: float
    y_m: float
    radius_m: float

    def nearest(self, x_m: float, y_m: float) -> tuple[float, float, float]:
        return self.x_m, self.y_m, self.radius_m

    def gap_m(self, actor: Actor) -> float:
        """Between this person and the robot's bumper."""
        return (
            math.dist((self.x_m, self.y_m), (actor.body.pose.x_m, actor.body.pose.y_m))
            - self.radius_m
            - BUMPER_RADIUS_M
        )


class Crowd:
    """Everybody in the tunnel who has no letter. `present` are those who are there now."""

    def __init__(self, campus: CampusMap, walkers: Sequence[Walker], standers: Sequence[Stander]) -> None:
        self._walkers = [(row, Bystander(*row.path[0], row.radius_m)) for row in walkers]
        self._walked_m = [0.0] * len(self._walkers)
        self._held_up_s = [0.0] * len(self._walkers)
        self._standers = [(row, Bystander(*stands_at(row, campus), row.radius_m)) for row in standers]
        self._met_s: list[float | None] = [None] * len(self._standers)
        self._gone = [False] * len(self._standers)
        self._last_s = 0.0
        self.present: list[Bystander] = []

    def tick(self, actors: Iterable[Actor], now: float) -> None:
        actors, passed_s, self._last_s = list(actors), now - self._last_s, now
        self.present = [
            *(
                one
                for number, (row, one) in enumerate(self._walkers)
                if self._walks(number, row, one, actors, passed_s)
            ),
            *(one for number, (row, one) in enumerate(self._standers) if self._stands(number, row, one, actors, now)),
        ]

    def _walks(self, number: int, row: Walker, one: Bystander, actors: list[Actor], passed_s: float) -> bool:
        """Goes on unless a robot is in the way, and then round it after a moment, as people do: a walker on the
        tape towards a robot and never gives way would hold up any robot for ever. Gone at the end of the path."""
        if self._last_s < row.at_s or (at := _on_path(row.path, self._walked_m[number])) is None:
            return False
        ahead = _on_path(row.path, self._walked_m[number] + row.speed_m_s * passed_s)
        x_m, y_m = ahead or at
        there = Bystander(x_m, y_m, row.radius_m)
        if all(there.gap_m(actor) > 0.02 or there.gap_m(actor) > one.gap_m(actor) for actor in actors):
            self._walked_m[number] += row.speed_m_s * passed_s
            self._held_up_s[number] = 0.0
            one.x_m, one.y_m = x_m, y_m
            return True
        self._held_up_s[number] += passed_s
        if self._held_up_s[number] >= GOES_ROUND_AFTER_S:
            self._walked_m[number] += 2 * (row.radius_m + ROBOT_M) + ROUND_IT_M
            self._held_up_s[number] = 0.0
            one.x_m, one.y_m = _on_path(row.path, self._walked_m[number]) or row.path[-1]
        return True

    def _stands(self, number: int, row: Stander, one: Bystander, actors: list[Actor], now: float) -> bool:
        if self._gone[number] or now < row.from_s:
            return False
        met_s = self._met_s[number]
        if met_s is None and any(one.gap_m(actor) < IN_FRONT_M for actor in actors):
            met_s = self._met_s[number] = now
        left = row.leaves_after_s is not None and met_s is not None and now - met_s >= row.leaves_after_s
        self._gone[number] = left or (row.until_s is not None and now >= row.until_s)
        return not self._gone[number]


def _on_path(path: Sequence[tuple[float, float]], walked_m: float) -> tuple[float, float] | None:
    """Where a walker is after so many metres; None beyond the end."""
    for a, b in pairwise(path):
        length_m = math.dist(a, b)
        if walked_m <= length_m and length_m:
            share = walked_m / length_m
            return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share
        walked_m -= length_m
    return None


def handings(letters: Iterable[Letter], seed: int) -> list[Handing]:
    """Both people of every order."""
    found = []
    for letter in letters:
        order = letter.order
        wrong = code(seed, order.id, "another person's")
        for post, person, gives in ((order.origin, order.sender, True), (order.destination, order.recipient, False)):
            found.append(Handing(letter, post, person, gives, Random(f"{seed}/{order.id}/{gives}"), wrong))
    return found
