"""The schedule of a map with bays: robots are where they report to be, and nothing is free before they do.

The schedule knows posts, their bays by number, and crossings; robots ask for spurs and corridors of the track. Which
bay a robot gets is decided here, when it is let in.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from app.traffic.bays import free_bay
from app.traffic.schedule import Elsewhere, HasToWait, Leg, MayEnter, TrafficSchedule, Verdict
from app.traffic.snapshot import Hold, RobotLocation, TrafficSnapshot
from app.traffic.standing import bay_ahead, lanes_of, standing
from fleet.schedule.controller import ComeIn, Denied, GoOn, Granted, LetIn, Waits
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane
from fleet.schedule.placing import Place


class BayTrafficSchedule(TrafficSchedule):
    """One for a campus whose posts have bays on the floor."""

    # What has happened.

    def _follow_closed(self, snapshot: TrafficSnapshot, now_s: float) -> None:
        self._close_and_open(snapshot.closed, now_s)

    def _placed(self, before: RobotLocation | None, now: RobotLocation, left_at: Mapping[int, str]) -> RobotLocation:
        return replace(now, post=standing(self.track, now).post)

    def _is_elsewhere(self, before: RobotLocation, now: RobotLocation) -> bool:
        return before.home_bay != now.home_bay

    def _join(self, now: RobotLocation, now_s: float) -> None:
        self.controller.joins(now.robot, home=now.home, now_s=now_s, **standing(self.track, now)._asdict())
        self._frozen.discard(now.robot)

    def _follow_one(self, before: RobotLocation, now: RobotLocation, now_s: float) -> None:
        """What it reports to have left is free. Where that does not lead to where it says to be, it has been carried,
        or has turned round."""
        held, left = lanes_of(self.track, now.holds), lanes_of(self.track, before.holds)
        for lane in (lane for lane in left if lane not in held):
            self.controller.crossed(now.robot, lane.from_post, now_s)
            self.controller.cleared(now.robot, lane.from_post, lane.to_post, now_s)
        where = standing(self.track, now)
        # A grant alone is no news of where it is.
        if now.occupies and now.occupies != before.occupies and now.occupies.kind != "crossing":
            self.controller.crossed(now.robot, where.post, now_s)
        if not self.controller.is_at(now.robot, where, now.home):
            self._join(now, now_s)

    def _wanted(self, now: RobotLocation) -> tuple[Goal, ...]:
        """First it moves into its own bay: until it is in, the schedule ends there. With work after that it would stay
        in the bay where it is."""
        goals = super()._wanted(now)
        return goals[:1] if self._moves_next_door(now) else goals

    def _moves_next_door(self, one: RobotLocation) -> bool:
        """Tell if it moves from another bay of the same post into its own."""
        home, here = one.home_bay, one.occupies
        if home is None or here is None or here.kind != "bay" or home == here.place:
            return False
        return self.track.address_of(home) == one.post and one.goes_into(home)

    # What follows.

    def verdicts(self, understood: Mapping[str, bool], now_s: float) -> Iterator[Verdict]:
        for name, one in self._known.items():
            if one.request is None or not one.online or name in self._frozen:
                continue
            verdict = self._asked(one, standing(self.track, one), now_s)
            if isinstance(verdict, MayEnter):
                self._known[name] = replace(
                    one, request=None, holds=(*one.holds, *(Hold(*leg) for leg in verdict.legs))
                )
            if verdict is not None:
                yield verdict

    def _asked(self, one: RobotLocation, where: Place, now_s: float) -> Verdict | None:
        assert one.request is not None  # noqa: S101  # only those are asked
        if where.rests:
            return self._out_of_bay(one, where, now_s)
        if where.waits_before is not None and one.request.legs[0][0] == where.waits_before:
            return self._over_the_post_ahead(one, where.waits_before, now_s)
        if where.on_crossing and not where.towards and one.request.legs[0][0] == where.post:
            return self._off_the_crossing(one, where)
        return None

    def _out_of_bay(self, one: RobotLocation, where: Place, now_s: float) -> Verdict | None:
        """Out of the bay, over the crossing, into the corridor; or to its own home at the same post."""
        assert one.request is not None and one.occupies is not None  # noqa: S101
        bay, post = one.occupies.place, where.post
        asked = next((leg for leg in one.request.legs if leg[0] == post), None)
        if asked is None or not self._is_lane(asked):
            return self._aside(one, bay, post, now_s, asked=True)
        if one.goals and one.goals[0].post == one.request.goal == post:
            return None  # first it does here what it has to do
        answer = self.controller.claims(one.robot, *asked, now_s)
        if isinstance(answer, Denied) and answer.instead is not None:
            answer = self.controller.claims(one.robot, *self._names(answer.instead), now_s)
        if isinstance(answer, Granted):
            leg = self._names(answer.lane)
            return MayEnter(one.robot, ((bay, post), leg), aside=leg != asked)
        move = self.controller.next_move(one.robot, now_s)
        if isinstance(move, ComeIn) and isinstance(answer, Waits):
            return self._aside(one, bay, post, now_s, asked=False)
        return self._waits(one, asked, answer)

    def _aside(self, one: RobotLocation, bay: str, post: str, now_s: float, *, asked: bool) -> Verdict:
        answer = self.controller.comes_in(one.robot, post, now_s)
        home = one.home_bay if one.home_bay and self.track.address_of(one.home_bay) == post else None
        if home not in (None, bay) and isinstance(answer, LetIn) and answer.at_home:
            return MayEnter(one.robot, ((bay, post), (post, home)), aside=not asked)
        return self._waits(one, (post, home or bay), answer)

    def _over_the_post_ahead(self, one: RobotLocation, post: str, now_s: float) -> Verdict | None:
        """From the end of its corridor straight on, or into a bay."""
        assert one.request is not None  # noqa: S101  # only those are asked
        asked, move = one.request.legs[0], self.controller.next_move(one.robot, now_s)
        if isinstance(move, GoOn):
            leg = self._names(move.lane)
            answer = self.controller.claims(one.robot, *leg, now_s)
            if isinstance(answer, Granted):
                return MayEnter(one.robot, (leg,), aside=leg != asked)
            return self._waits(one, leg, answer)
        if not isinstance(move, ComeIn):
            return None
        if self._post(move.post) != post:  # one stands still on the crossing: back to where it came from
            return Elsewhere(one.robot, (self._post(move.post), post))
        bay = self._bay_at(one, post, at_home=move.at_home)
        if bay is None:
            return self._waits(one, asked, None)
        let_in = self.controller.comes_in(one.robot, post, now_s)
        if isinstance(let_in, LetIn):
            legs = ((post, bay), *self._out_of_silence(one, post, bay))
            return MayEnter(one.robot, legs, aside=self._is_lane(asked))
        return self._waits(one, asked, let_in)

    def _out_of_silence(self, one: RobotLocation, post: str, bay: str) -> tuple[Leg, ...]:
        """From a bay without network it cannot ask for a way out. It gets the one by which it comes: no report of it
        comes from there either, so that corridor and crossing stay its own."""
        if self.track.post(post).network or one.occupies is None:
            return ()
        return (bay, post), (post, one.occupies.place)

    def _off_the_crossing(self, one: RobotLocation, where: Place) -> Verdict:
        """It could not get into its bay, or was put on the crossing: into another bay, which is kept for it."""
        assert one.request is not None  # noqa: S101  # only those are asked
        bay = self._bay_at(one, where.post, at_home=where.at_home) or self._bay_at(one, where.post, at_home=False)
        if bay is None or bay == bay_ahead(self.track, one, where.post):
            return self._waits(one, one.request.legs[0], None)
        return MayEnter(one.robot, ((where.post, bay),), aside=one.request.legs[0] != (where.post, bay))

    def _bay_at(self, one: RobotLocation, post: str, *, at_home: bool) -> str | None:
        if at_home:
            return one.home_bay
        return free_bay(self.track, post, one, self._known.values(), self._closed)

    def _waits(self, one: RobotLocation, leg: Leg, answer: Waits | Denied | LetIn | None) -> HasToWait:
        if isinstance(answer, Waits):
            return HasToWait(one.robot, self._addresses(leg), answer.robots, in_turn=True)
        closed = self._is_lane(leg) and self.track.corridor(*leg).name in self._closed
        before = dict.fromkeys((*self._holders(leg), *self._in_the_way(one, one.request.goal if one.request else "")))
        return HasToWait(one.robot, self._addresses(leg), tuple(before), closed=closed)

    # Names.

    def _is_lane(self, leg: Leg) -> bool:
        return not any(self.track.post(place).bay_of for place in leg)

    def _addresses(self, leg: Leg) -> Leg:
        return self.track.address_of(leg[0]), self.track.address_of(leg[1])

    def _post(self, number: int) -> str:
        return self.controller.network.posts[number]

    def _names(self, lane: Lane) -> Leg:
        return self._post(lane.start), self._post(lane.end)
