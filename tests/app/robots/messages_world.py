"""Robots that move and say so by messages that come late, the rows that a database would have of them, and a schedule
that is asked about both. What is true and what is known are kept apart: meetings are looked for in the truth.
"""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from itertools import count, pairwise
from random import Random

from app.core.settings import Settings
from app.traffic.schedule import Elsewhere, Leg, MayEnter, TrafficSchedule, Verdict
from app.traffic.snapshot import OF_ITS_OWN, Hold, ReservationRequest, RobotLocation, Stop, TrafficSnapshot
from maps import CampusMap, NoRoute, corridor_name, shortest_route

BEGIN = datetime(2026, 1, 1, tzinfo=UTC)
SPEED_M_S = 0.2
HANDOVER_S = 20.0
VANISHED_AFTER_S = 120.0


@dataclass
class Grant:
    """A row: given, cleared or not, and where the robot stood then."""

    number: int
    robot: str
    leg: Leg
    left_at: str | None = None
    cleared_at: datetime = BEGIN

    @property
    def corridor(self) -> str:
        return corridor_name(*self.leg)


@dataclass
class Row:
    """The database's row of a robot."""

    post: str
    seen_at: datetime
    docked: bool
    online: bool = True
    stopped: bool = False
    request: ReservationRequest | None = None
    goals: list[Stop] = field(default_factory=list)
    heard_at: datetime = BEGIN


@dataclass
class Robot:
    """The true state of a robot."""

    name: str
    home: str
    post: str
    docked: bool
    lane: Leg | None = None
    busy_until_s: float = 0.0
    serves: str | None = None
    granted: deque[Grant] = field(default_factory=deque)
    asked: str | None = None
    avoids: set[str] = field(default_factory=set)
    is_dead: bool = False
    is_stopped: bool = False


class World:
    """Every random choice is its `rng`'s."""

    def __init__(self, campus: CampusMap, settings: Settings, rng: Random, robots: int) -> None:
        self.campus, self.settings, self.rng = campus, settings, rng
        self.now_s = 0.0
        homes = rng.sample(sorted(campus.posts), robots)
        self.robots = [Robot(f"r{number}", home, home, docked=True) for number, home in enumerate(homes, start=1)]
        self.rows = {robot.name: Row(robot.post, BEGIN, docked=True) for robot in self.robots}
        self.grants: list[Grant] = []
        self.closed: set[str] = set()
        self.schedule: TrafficSchedule | None = None
        self.served = self.looks = 0
        self._numbers = count(1)
        self._coming: dict[str, deque[tuple[float, Callable[[], None]]]] = {r.name: deque() for r in self.robots}
        self._answers: dict[str, deque[tuple[float, Callable[[], None]]]] = {r.name: deque() for r in self.robots}
        self.late_s = 8.0

    @property
    def now(self) -> datetime:
        return BEGIN + timedelta(seconds=self.now_s)

    # Messages.

    def _say(self, robot: Robot, write: Callable[[], None]) -> None:
        self._send(self._coming[robot.name], write)

    def _send(self, line: deque[tuple[float, Callable[[], None]]], act: Callable[[], None]) -> None:
        last_s = line[-1][0] if line else self.now_s
        line.append((max(last_s, self.now_s + self.rng.uniform(0.0, self.late_s)), act))

    def deliver(self) -> None:
        """Deliver the messages due by now, in the order in which each robot sent or was sent them; the dead wait."""
        for robot in self.robots:
            if robot.is_dead:
                continue
            for line in (self._coming[robot.name], self._answers[robot.name]):
                while line and line[0][0] <= self.now_s:
                    line.popleft()[1]()
                    self.rows[robot.name].heard_at = self.now

    # Robots.

    def move(self) -> None:
        """Each robot does what it can do now."""
        for robot in self.robots:
            if robot.is_dead or robot.is_stopped or robot.busy_until_s > self.now_s:
                continue
            if robot.lane:
                self._arrive(robot)
            if robot.serves:
                self._has_served(robot)
            self._go_on(robot)

    def _arrive(self, robot: Robot) -> None:
        assert robot.lane is not None
        robot.post, robot.lane = robot.lane[1], None
        through = robot.granted.popleft()
        self._clear(robot, [through])
        robot.avoids.clear()
        if robot.post == robot.home and not self._goals(robot) and not robot.granted:
            robot.docked = True
        self._seen(robot)

    def _clear(self, robot: Robot, grants: list[Grant]) -> None:
        post = robot.post

        def write() -> None:
            for grant in grants:
                grant.left_at, grant.cleared_at = post, self.now

        self._say(robot, write)

    def _seen(self, robot: Robot) -> None:
        row, at, post, docked, stopped = self.rows[robot.name], self.now, robot.post, robot.docked, robot.is_stopped

        def write() -> None:
            row.post, row.seen_at, row.docked, row.stopped = post, at, docked, stopped

        self._say(robot, write)

    def _has_served(self, robot: Robot) -> None:
        goals, key = self.rows[robot.name].goals, robot.serves
        robot.serves = None

        def write() -> None:
            kept = [goal for goal in goals if goal[0] != key]
            self.served += len(goals) - len(kept)
            goals[:] = kept

        self._say(robot, write)

    def _goals(self, robot: Robot) -> list[Stop]:
        return self.rows[robot.name].goals

    def _go_on(self, robot: Robot) -> None:
        goals = self._goals(robot)
        if robot.granted and robot.granted[0].leg[0] == robot.post:
            self._enter(robot)
        elif goals and goals[0][1] == robot.post and not self._coming[robot.name]:
            robot.serves, robot.busy_until_s = goals[0][0], self.now_s + self.rng.uniform(0.5, 2.0) * HANDOVER_S
        elif robot.asked is None and not robot.granted and not (goals and goals[0][1] == robot.post):
            self._ask(robot, goals[0][1] if goals else robot.home)

    def _enter(self, robot: Robot) -> None:
        leg = robot.granted[0].leg
        inside = [other for other in self.robots if other.lane and corridor_name(*other.lane) == corridor_name(*leg)]
        corridor = self.campus.corridor(*leg)
        follows = corridor.following_s is not None and all(other.lane == leg for other in inside)
        assert not inside or follows, f"{robot.name} meets {inside[0].name} between {' and '.join(leg)}"
        robot.lane, robot.docked = leg, False
        robot.busy_until_s = self.now_s + corridor.length_m / SPEED_M_S * self.rng.uniform(1.0, 3.0)

    def _ask(self, robot: Robot, goal: str) -> None:
        if goal == robot.post:
            if not robot.docked:
                robot.docked = robot.post == robot.home
                self._seen(robot)
            return
        try:
            posts = shortest_route(self.campus, robot.post, goal, robot.avoids).posts
        except NoRoute:
            robot.avoids.clear()
            return
        legs = tuple(pairwise(posts))
        first, then = legs[:1], legs[1:]
        if self.rng.random() < 0.1:  # it does not know which way it looks
            others = [(robot.post, post.name) for post, _ in self.campus.neighbours(robot.post)]
            first, then = (*first, *(leg for leg in others if leg != legs[0])), ()
        request = ReservationRequest(f"c{next(self._numbers)}", first, goal, then)
        robot.asked = request.claim_id
        self._say(robot, lambda: setattr(self.rows[robot.name], "request", request))

    # What goes wrong.

    def trouble(self) -> None:
        """One thing of many kinds, at random."""
        robot = self.rng.choice(self.robots)
        kinds = (
            self._die_or_live,
            self._stop_or_go_on,
            self._withdraw,
            self._order,
            self._order,
            self._drop,
            self._close_or_open,
            self._forget_schedule,
        )
        self.rng.choice(kinds)(robot)

    def _die_or_live(self, robot: Robot) -> None:
        robot.is_dead = not robot.is_dead
        self.rows[robot.name].online = not robot.is_dead

    def _stop_or_go_on(self, robot: Robot) -> None:
        if not robot.is_dead:
            robot.is_stopped = not robot.is_stopped
            self._seen(robot)

    def _withdraw(self, robot: Robot) -> None:
        """It takes back what it waits for, or what it was granted and has not entered."""
        if robot.is_dead:
            return
        if robot.asked is not None:
            claim, robot.asked = robot.asked, None
            self._say(robot, lambda: self._take_back(robot.name, claim))
        ahead = list(robot.granted)[1 if robot.lane else 0 :]
        if ahead and not robot.lane:
            robot.granted.clear()
            self._clear(robot, ahead)

    def _take_back(self, name: str, claim: str) -> None:
        """Withdraw a claim. A grant made meanwhile is given back as it comes: see `_granted`."""
        request = self.rows[name].request
        if request is not None and request.claim_id == claim:
            self.rows[name].request = None

    def _order(self, robot: Robot) -> None:
        if len(self._goals(robot)) < 3:
            self._goals(robot).append(Stop(f"g{next(self._numbers)}", self.rng.choice(sorted(self.campus.posts))))

    def _drop(self, robot: Robot) -> None:
        goals = self._goals(robot)
        if goals and robot.serves is None:
            goals.remove(self.rng.choice(goals))

    def _close_or_open(self, _robot: Robot) -> None:
        corridor = self.rng.choice(self.campus.corridors).name
        self.closed ^= {corridor}

    def _forget_schedule(self, _robot: Robot) -> None:
        self.schedule = None

    def calm(self) -> None:
        """Everything that goes wrong has gone right again."""
        for robot in self.robots:
            robot.is_dead, self.rows[robot.name].online = False, True
            if robot.is_stopped:
                self._stop_or_go_on(robot)
        self.closed.clear()

    # The service.

    def look(self) -> None:
        """As the traffic service does: follow, ask for verdicts, write them down."""
        self.looks += 1
        picture = self._picture()
        schedule = self.schedule
        if schedule is None:
            schedule = TrafficSchedule(self.campus, self.settings)
            picture = replace(picture, robots={name: self._where_left(one) for name, one in picture.robots.items()})
        held = {hold.grant_id for one in schedule.known.values() for hold in one.holds}
        left = {grant.number: grant.left_at or grant.leg[1] for grant in self.grants if grant.number in held}
        schedule.vanished = frozenset(name for name, one in picture.robots.items() if self._has_vanished(one))
        schedule.follow(picture, left, self.now_s)
        for verdict in list(schedule.verdicts(dict.fromkeys(picture.robots, True), self.now_s)):
            self._write(verdict)
        self.schedule = schedule

    def _has_vanished(self, one: RobotLocation) -> bool:
        silent_s = (self.now - (one.heard_at or BEGIN)).total_seconds()
        return not one.online and bool(one.holds or not one.at_home) and silent_s > VANISHED_AFTER_S

    def _picture(self) -> TrafficSnapshot:
        return TrafficSnapshot(
            {robot.name: self._seen_by_the_service(robot) for robot in self.robots}, frozenset(self.closed)
        )

    def _seen_by_the_service(self, robot: Robot) -> RobotLocation:
        row = self.rows[robot.name]
        holds = tuple(Hold(*g.leg, g.number) for g in self.grants if g.robot == robot.name and g.left_at is None)
        own = row.request and not row.request.is_for_later and not (row.goals and row.goals[0][1] == row.request.goal)
        return RobotLocation(
            robot=robot.name,
            post=row.post,
            seen_at=row.seen_at,
            home=robot.home,
            at_home=row.docked and row.post == robot.home,
            online=row.online,
            holds=holds,
            goals=((Stop(OF_ITS_OWN, row.request.goal),) if row.request and own else ()) + tuple(row.goals),
            request=row.request,
            stopped=row.stopped,
            heard_at=row.heard_at,
        )

    def _where_left(self, one: RobotLocation) -> RobotLocation:
        cleared = [grant for grant in self.grants if grant.robot == one.robot and grant.left_at]
        last = max(cleared, key=lambda grant: grant.cleared_at, default=None)
        is_news = last is not None and (one.seen_at is None or one.seen_at < last.cleared_at)
        return replace(one, post=last.left_at) if last and last.left_at and is_news else one

    def _write(self, verdict: Verdict) -> None:
        robot = next(one for one in self.robots if one.name == verdict.robot)
        row = self.rows[robot.name]
        claim = row.request.claim_id if row.request else ""
        match verdict:
            case MayEnter(legs=legs):
                new = [Grant(next(self._numbers), robot.name, leg) for leg in legs]
                self._check(new)
                self.grants += new
                row.request = None
                self._send(self._answers[robot.name], lambda: self._granted(robot, claim, new))
            case Elsewhere(leg=leg):
                row.request = None
                self._send(self._answers[robot.name], lambda: self._denied(robot, claim, leg))

    def _check(self, new: list[Grant]) -> None:
        for grant in new:
            follows = self.campus.corridor(*grant.leg).following_s is not None
            for other in self.grants:
                if other.left_at is None and other.corridor == grant.corridor and other.robot != grant.robot:
                    assert follows and other.leg == grant.leg, f"{grant} beside {other}"

    def _granted(self, robot: Robot, claim: str, new: list[Grant]) -> None:
        """Give back grants of a claim it has taken back. Of several first corridors it takes the one it was told."""
        if robot.asked != claim:
            self._clear(robot, new)
            return
        robot.asked = None
        beside = [grant for grant in new[1:] if grant.leg[0] == new[0].leg[0]]
        if beside:
            self._clear(robot, beside)
        robot.granted.extend(grant for grant in new if grant not in beside)

    def _denied(self, robot: Robot, claim: str, leg: Leg) -> None:
        if robot.asked == claim:
            robot.asked = None
            robot.avoids.add(corridor_name(*leg))

    # Time.

    def steps(self, number: int) -> Iterator[None]:
        """Time goes on, everybody does what they can, the service looks."""
        for _ in range(number):
            self.now_s += self.rng.uniform(0.5, 15.0)
            self.deliver()
            self.move()
            self.look()
            yield

    @property
    def is_at_rest(self) -> bool:
        return all(robot.docked and not self._goals(robot) for robot in self.robots)
