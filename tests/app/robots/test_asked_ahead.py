"""A robot's requests for corridors on its way, and how much of the way it is granted at once."""

from dataclasses import replace

from app.core.settings import Settings
from app.traffic.schedule import HasToWait, MayEnter, TrafficSchedule
from app.traffic.snapshot import ReservationRequest, RobotLocation, Stop, TrafficSnapshot
from tests.plain_maps import plain_map

WAY = (("post1", "post2"), ("post2", "post3"), ("post3", "post4"))
LOADS, GIVES = Stop("load", "post1"), Stop("give", "post4")
ASKS_WHILE_IT_COMES = RobotLocation(
    robot="r1",
    post="post1",
    seen_at=None,
    home="post5",
    at_home=False,
    online=True,
    holds=(),
    goals=(LOADS, GIVES),
    request=ReservationRequest("c1", WAY[:1], "post1", WAY[1:]),
    stopped=False,
    heard_at=None,
)


def test_what_is_asked_for_after_a_stop_is_granted_after_it_as_far_as_the_next(settings: Settings) -> None:
    schedule = TrafficSchedule(plain_map("test_track"), settings)
    schedule.follow(TrafficSnapshot({"r1": ASKS_WHILE_IT_COMES}, frozenset()), {}, 0.0)
    assert list(schedule.verdicts({}, 0.0)) == []
    loaded = replace(ASKS_WHILE_IT_COMES, goals=(GIVES,))
    schedule.follow(TrafficSnapshot({"r1": loaded}, frozenset()), {}, 60.0)
    assert list(schedule.verdicts({}, 60.0)) == [MayEnter("r1", WAY)]
    assert [hold.to_post for hold in schedule.known["r1"].way] == ["post2", "post3", "post4"]


def test_a_robot_asks_from_where_it_stands_wherever_it_was_seen_last(settings: Settings) -> None:
    """A schedule that is made anew has not heard on which way it came here."""
    schedule = TrafficSchedule(plain_map("test_track"), settings)
    asks = replace(
        ASKS_WHILE_IT_COMES, post="post5", goals=(GIVES,), request=ReservationRequest("c1", WAY[:1], "post4", WAY[1:])
    )
    schedule.follow(TrafficSnapshot({"r1": asks}, frozenset()), {}, 0.0)
    assert list(schedule.verdicts({}, 0.0)) == [MayEnter("r1", WAY)]


def test_a_robot_that_was_silent_and_asks_again_in_the_same_look_is_let_in(settings: Settings) -> None:
    schedule = TrafficSchedule(plain_map("test_track"), settings, vanished=frozenset({"r1"}))
    silent = replace(ASKS_WHILE_IT_COMES, request=None, goals=(), online=False)
    schedule.follow(TrafficSnapshot({"r1": silent}, frozenset()), {}, 0.0)
    schedule.vanished = frozenset()
    asks = replace(ASKS_WHILE_IT_COMES, goals=(GIVES,), request=ReservationRequest("c1", WAY[:1], "post4", WAY[1:]))
    schedule.follow(TrafficSnapshot({"r1": asks}, frozenset()), {}, 60.0)
    assert list(schedule.verdicts({}, 60.0)) == [MayEnter("r1", WAY)]


def test_what_a_robot_may_enter_besides_is_no_other_robots_in_the_same_look(settings: Settings) -> None:
    """It does not know which way it looks, so all that leads away from where it stands is its own."""
    schedule = TrafficSchedule(plain_map("test_track"), settings)
    first = (("post3", "post2"), ("post3", "post4"), ("post3", "post5"))
    lost = replace(ASKS_WHILE_IT_COMES, post="post3", goals=(LOADS,), request=ReservationRequest("c1", first, "post1"))
    other = replace(
        lost, robot="r2", post="post5", goals=(GIVES,), request=ReservationRequest("c2", (("post5", "post3"),), "post4")
    )
    schedule.follow(TrafficSnapshot({"r1": lost, "r2": other}, frozenset()), {}, 0.0)
    granted, waits = schedule.verdicts({}, 0.0)
    assert isinstance(granted, MayEnter)
    assert granted.legs == first
    assert isinstance(waits, HasToWait)
    assert waits.robots == ("r1",)
