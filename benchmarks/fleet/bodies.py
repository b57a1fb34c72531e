"""Robots as bodies on the floor, and a service that knows of them by their reports alone, through the real controller.

A body is in a bay, at home, in a corridor, at its end, or on a crossing: first still partly in what it leaves, then
partly in what it comes to. What it does is told by messages that come late, each robot's in their order, and twice if
an answer was lost. Where bodies truly are is never asked of the controller, and never told to it in another way.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

from fleet.schedule.answers import ComeIn, Denied, GoOn, Granted, LetIn, Waits
from fleet.schedule.controller import TrafficController
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane, Network

STEP_S: Final = 7.0


class MeetingError(AssertionError):
    """Two bodies where there is room for one."""


class Place(NamedTuple):
    """`what`: bay, home, lane, end (of a lane) or over (a crossing). Over a crossing `begun` says whether the body is
    still partly in what it leaves (`source`), else partly in what it comes to (`target`)."""

    what: str
    post: int
    lane: Lane | None = None
    source: "Place | None" = None
    target: "Place | None" = None
    begun: bool = False

    @property
    def rests(self) -> bool:
        return self.what in ("bay", "home")


class Message(NamedTuple):
    """`what`: cleared, crossed, turned, served or asks."""

    what: str
    post: int = 0
    lane: Lane | None = None
    key: str = ""


@dataclass(frozen=True)
class Body:
    """`out`: what it has said and was not heard; `told`: what it may do and has not begun, and `ahead`: corridors that
    it was let into with that. `asks`: it has asked what to do, and has had no answer."""

    home: int
    place: Place
    goals: tuple[Goal, ...]
    out: tuple[Message, ...] = ()
    told: Granted | LetIn | ComeIn | None = None
    ahead: tuple[Lane, ...] = ()
    asks: bool = False
    is_dead: bool = False


@dataclass(frozen=True)
class Record:
    """What a service has written down of a robot, to begin anew with: the arguments of `joins`."""

    post: int
    at_home: bool
    towards: tuple[int, ...] = ()
    on_crossing: bool = False
    to_home: bool = False
    is_let_in: bool = False
    goals: tuple[Goal, ...] = ()
    waits: bool = False
    let_in_s: float = 0.0


@dataclass
class Floor:
    """The bodies, the service's records, and its controller. `far`: robots are let into as much of their way as no
    other enters before them."""

    network: Network
    controller: TrafficController
    bodies: dict[str, Body]
    far: bool = False
    records: dict[str, Record] = field(default_factory=dict)
    now_s: float = 0.0
    asked: dict[str, object] = field(default_factory=dict)
    inside: dict[int, tuple[str, ...]] = field(default_factory=dict)
    """In each corridor: the bodies, beginning at its end a."""

    @classmethod
    def at_rest(
        cls, network: Network, bodies: Mapping[str, Body], controller: TrafficController, *, far: bool = False
    ) -> "Floor":
        floor = cls(network, controller, dict(bodies), far)
        for name, body in bodies.items():
            floor.records[name] = Record(body.place.post, body.place.what == "home", goals=body.goals)
            floor._joins(name)
        for name, body in bodies.items():
            assert controller.give(name, body.goals, 0.0), "all robots come home, so that work can be taken on"
        return floor

    # What can happen.

    def actions(self) -> Iterator[tuple[str, str]]:
        """Everything that may happen next, as its name and the robot's."""
        for name, body in sorted(self.bodies.items()):
            if body.out:
                yield "hear", name
            if not body.is_dead and self._can_move(name, body):
                yield "move", name

    def act(self, what: str, name: str) -> None:
        """Raises MeetingError."""
        self.now_s += STEP_S
        match what:
            case "move":
                self._move(name)
                self.look()
            case "hear" | "hear_twice":
                self._hears(name, self.bodies[name].out[0])
                if what == "hear_twice":  # it has heard no answer, and says so again
                    self._hears(name, self.bodies[name].out[0])
                self._set(name, out=self.bodies[name].out[1:])
                self.poll()
            case "die":
                self._set(name, is_dead=True)
                self.controller.freeze(name, self.now_s)
                self.poll()
            case "go_on":
                self._set(name, is_dead=False)
                self.asked.pop(name, None)
                self.controller.unfreeze(name, self.now_s)
                self.poll()

    def restart(self, controller: TrafficController) -> None:
        """The service forgets all but its records."""
        self.controller, self.asked = controller, {}
        for name in sorted(self.records, key=lambda name: self.records[name].let_in_s):
            self._joins(name)
        for name, record in self.records.items():
            goals_are_planned = controller.give(name, record.goals, self.now_s)
            assert goals_are_planned or controller.out_of_reach()
        for name, body in self.bodies.items():
            if body.is_dead:
                controller.freeze(name, self.now_s)
        self.poll()

    def is_done(self) -> bool:
        return all(
            not (body.goals or body.out) and (body.place.what, body.place.post) == ("home", body.home)
            for body in self.bodies.values()
        )

    # What is true.

    def look(self) -> None:
        """Raises MeetingError if two bodies are where there is room for one."""
        taken: dict[tuple[str, int], str] = {}
        standing: dict[int, int] = {}
        for name, body in self.bodies.items():
            for what, number in _occupied(body.place):
                is_nobodys = what == "crossing" and not self.network.crossing_s[number]
                if what == "bay":
                    standing[number] = standing.get(number, 0) + 1
                elif not is_nobodys and (other := taken.setdefault((what, number), name)) != name:
                    raise MeetingError(f"{name} meets {other}: {what} {number}")
        for post, bodies in standing.items():
            if bodies > self.network.bays[post]:
                raise MeetingError(f"{bodies} bodies in the bays of {self.network.posts[post]}")

    # What a robot does.

    def _set(self, name: str, **changes: object) -> None:
        self.bodies[name] = replace(self.bodies[name], **changes)  # type: ignore[arg-type]

    def _say(self, name: str, *messages: Message) -> None:
        self._set(name, out=(*self.bodies[name].out, *messages))

    def _can_move(self, name: str, body: Body) -> bool:
        place = body.place
        if place.what == "lane" and body.told is None and not self._is_first(name, place):
            return False
        if place.what in ("lane", "over") or body.told is not None or body.ahead:
            return True
        if place.rests and body.goals and body.goals[0].post == place.post:
            return True
        return not body.asks and not (body.out and body.out[-1].what == "asks") and not self._has_nothing_to_do(body)

    def _is_first(self, name: str, place: Place) -> bool:
        """No body is between it and the end of its corridor."""
        assert place.lane is not None
        inside = self.inside.get(place.lane.corridor, (name,))
        return inside[0 if place.lane.backwards else -1] == name

    def _enters(self, name: str, lane: Lane) -> None:
        inside = self.inside.get(lane.corridor, ())
        for other in inside:
            there = self.bodies[other].place
            if lane.following_s is None or (there.lane is not None and there.lane.end == lane.start):
                raise MeetingError(f"{name} comes towards {other} in {self.network.corridors[lane.corridor]}")
        self.inside[lane.corridor] = (*inside, name) if lane.backwards else (name, *inside)

    def _leaves(self, name: str, lane: Lane) -> None:
        self.inside[lane.corridor] = tuple(one for one in self.inside[lane.corridor] if one != name)

    def _has_nothing_to_do(self, body: Body) -> bool:
        return not body.goals and (body.place.what, body.place.post) == ("home", body.home)

    def _move(self, name: str) -> None:
        body, place = self.bodies[name], self.bodies[name].place
        if place.what == "over":
            self._goes_over(name, place)
        elif place.rests and body.goals and body.goals[0].post == place.post and body.told is None:
            self._set(name, goals=body.goals[1:])
            self._say(name, Message("served", key=body.goals[0].key))
        elif isinstance(body.told, ComeIn):  # it turns round
            assert place.lane is not None
            back = next(lane for lane in self.network.lanes[place.post] if lane.corridor == place.lane.corridor)
            self._set(name, place=Place("lane", back.end, back), told=None)
            self._say(name, Message("turned", lane=back))
        elif place.what == "lane":
            self._set(name, place=place._replace(what="end"))
        elif place.what == "end" and body.ahead and body.told is None:
            self._set(name, ahead=body.ahead[1:])
            self._begins_to_cross(name, Granted(body.ahead[0]))
        elif body.told is not None:
            self._begins_to_cross(name, body.told)
        else:
            self._set(name, asks=True)
            self._say(name, Message("asks"))

    def _begins_to_cross(self, name: str, told: Granted | LetIn | ComeIn) -> None:
        place = self.bodies[name].place
        if isinstance(told, Granted):
            assert told.lane.start == place.post
            target = Place("lane", told.lane.end, told.lane)
        else:
            target = Place("home" if told.at_home else "bay", told.post)
        self._set(name, told=None, place=Place("over", place.post, source=place, target=target, begun=True))

    def _goes_over(self, name: str, place: Place) -> None:
        assert place.source is not None and place.target is not None
        if place.begun:
            self._set(name, place=place._replace(begun=False))
            if place.target.lane is not None:
                self._enters(name, place.target.lane)
            if place.source.lane is not None:
                self._leaves(name, place.source.lane)
                self._say(name, Message("cleared", lane=place.source.lane))
        else:
            self._set(name, place=place.target)
            self._say(name, Message("crossed", post=place.post))

    # What the service does.

    def _hears(self, name: str, message: Message) -> None:
        record, posts, controller = self.records[name], self.network.posts, self.controller
        match message.what:
            case "served":
                self.records[name] = replace(record, goals=tuple(one for one in record.goals if one.key != message.key))
                controller.served(name, message.key, self.now_s)
            case "asks":
                self.records[name] = replace(record, waits=True)
            case "turned":
                assert message.lane is not None
                self.records[name] = self._turned(name, message.lane)
            case "cleared":
                assert message.lane is not None
                self._write_cleared(name, message.lane)
                controller.cleared(name, posts[message.lane.start], posts[message.lane.end], self.now_s)
            case "crossed":
                self._write_crossed(name, message.post)
                controller.crossed(name, posts[message.post], self.now_s)

    def _write_cleared(self, name: str, lane: Lane) -> None:
        record, home = self.records[name], self.bodies[name].home
        if record.towards and {record.post, record.towards[0]} == {lane.start, lane.end}:
            here, *ahead = record.towards
            self.records[name] = replace(
                record,
                post=here,
                towards=tuple(ahead),
                at_home=record.to_home and here == home,
                to_home=record.to_home and home in ahead,
                on_crossing=self.network.crossing_s[here] > 0,
                is_let_in=False,
            )

    def _write_crossed(self, name: str, post: int) -> None:
        record = self.records[name]
        if record.on_crossing and record.post == post:
            makes_room = record.to_home and not record.towards
            at_home, to_home = record.at_home or makes_room, record.to_home and not makes_room
            self.records[name] = replace(record, on_crossing=False, at_home=at_home, to_home=to_home)

    def poll(self) -> None:
        """Answer who asks: anew, or as what was asked for becomes free."""
        for name, answer in self.controller.grants(self.now_s):
            self._answers(name, answer)
        for name in [name for name, record in self.records.items() if record.waits]:
            if self.bodies[name].is_dead:
                continue
            move = self.controller.next_move(name, self.now_s)
            if self.asked.get(name) != move:
                self.asked[name] = move
                self._asks_for(name, move)

    def _asks_for(self, name: str, move: GoOn | ComeIn | None) -> None:
        record, posts = self.records[name], self.network.posts
        if isinstance(move, GoOn):
            ends = posts[move.lane.start], posts[move.lane.end]
            self._answers(name, self.controller.claims(name, *ends, self.now_s))
        elif isinstance(move, ComeIn):
            if record.towards and move.post != record.towards[-1]:
                self._tell(name, move)
            else:
                self._answers(name, self.controller.comes_in(name, posts[move.post], self.now_s))

    def _turned(self, name: str, back: Lane) -> Record:
        record, home = self.records[name], self.bodies[name].home
        return replace(record, post=back.start, towards=(back.end,), to_home=back.end == home)

    def _answers(self, name: str, answer: Granted | LetIn | Waits | Denied) -> None:
        record = self.records[name]
        match answer:
            case Granted(lane, at_home):
                starts = not record.towards and self.network.crossing_s[lane.start] > 0
                self.records[name] = replace(
                    record,
                    towards=(*record.towards, lane.end),
                    to_home=at_home or (record.to_home and bool(record.towards)),
                    on_crossing=record.on_crossing or starts,
                    let_in_s=self.now_s if lane.following_s is not None else 0.0,
                )
                self._tell(name, answer)
                if self.far:
                    self._lets_further(name)
            case LetIn(_, at_home):
                if record.towards:
                    self.records[name] = replace(record, is_let_in=True)
                else:
                    self.records[name] = replace(record, on_crossing=True, to_home=at_home)
                self._tell(name, answer)
            case Denied():
                self.asked.pop(name, None)

    def _lets_further(self, name: str) -> None:
        posts, legs = self.network.posts, self.controller.journeys(self.now_s)[name].legs[1:]
        way = [(posts[leg.lane.start], posts[leg.lane.end]) for leg in legs if leg.lane is not None]
        ahead = tuple(self.controller.goes_on(name, way, self.now_s))
        self._set(name, ahead=ahead)
        record, comes_home = self.records[name], self.controller.comes_home(name)
        towards = *record.towards, *(lane.end for lane in ahead)
        self.records[name] = replace(record, towards=towards, to_home=record.to_home or comes_home)

    def _tell(self, name: str, answer: Granted | LetIn | ComeIn) -> None:
        self.records[name] = replace(self.records[name], waits=False)
        self.asked.pop(name, None)
        assert self.bodies[name].told is None
        self._set(name, told=answer, asks=False)

    def _joins(self, name: str) -> None:
        record, posts = self.records[name], self.network.posts
        self.controller.joins(
            name,
            post=posts[record.post],
            home=posts[self.bodies[name].home],
            at_home=record.at_home,
            now_s=self.now_s,
            towards=[posts[post] for post in record.towards],
            on_crossing=record.on_crossing,
            to_home=record.to_home,
            is_let_in=record.is_let_in,
        )


def _occupied(place: Place) -> Iterator[tuple[str, int]]:
    """Everything that a body is in, wholly or partly."""
    if place.what == "bay":
        yield "bay", place.post
    elif place.lane is not None and place.lane.following_s is None:
        yield "corridor", place.lane.corridor
    elif place.what == "over":
        yield "crossing", place.post
        inside = place.source if place.begun else place.target
        assert inside is not None
        yield from _occupied(inside)


def standing_bodies(homes: Sequence[int], goals: Sequence[int | None], *, in_bays: bool = False) -> dict[str, Body]:
    """Robots at home, or in bays at their home posts, with one goal each, or none."""
    what = "bay" if in_bays else "home"
    return {
        f"r{number}": Body(home, Place(what, home), () if goal is None else (Goal(goal, 5.0, key=f"goal {number}"),))
        for number, (home, goal) in enumerate(zip(homes, goals, strict=True))
    }
