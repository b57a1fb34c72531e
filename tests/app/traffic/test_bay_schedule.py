"""The schedule of a map with bays, by pictures of the traffic: what it grants, and what it lets wait."""

from dataclasses import replace
from itertools import pairwise
from typing import Final

from app.core.settings import Settings
from app.traffic.bay_schedule import BayTrafficSchedule
from app.traffic.robot_locations import Hold, Occupied, ReservationRequest, RobotLocation, TrafficSnapshot
from app.traffic.schedule import MayEnter, Verdict
from maps import find_map
from tests.app.traffic.bay_travelling import MAP

GUEST: Final = RobotLocation(
    robot="r1",
    post="post4",
    seen_at=None,
    home="post5",
    at_home=False,
    online=True,
    holds=(),
    goals=(("stop", "post4"), ("next", "post1")),
    request=None,
    stopped=False,
    heard_at=None,
    occupies=Occupied("bay", "post4_bay1"),
    home_bay="post5_bay2",
)
"""It stands in a bay of post4 for a stop there, and goes to post1 then."""


def asks(robot: RobotLocation, goal: str, *places: str) -> RobotLocation:
    legs = tuple(pairwise(places))
    return replace(robot, request=ReservationRequest(f"for {goal}", legs[:1], goal, legs[1:], legs))


def verdicts(settings: Settings, *pictures: RobotLocation | tuple[RobotLocation, ...]) -> list[Verdict]:
    """On the last of these pictures."""
    schedule, found = BayTrafficSchedule(find_map(MAP), settings), list[Verdict]()
    for now_s, picture in enumerate(pictures):
        robots = picture if isinstance(picture, tuple) else (picture,)
        schedule.follow(TrafficSnapshot({one.robot: one for one in robots}, frozenset()), {}, float(now_s))
        found = list(schedule.verdicts({}, float(now_s)))
    return found


WAY: Final = "post4_bay1", "post4", "post3", "post2", "post1", "post1_bay1"


def test_who_has_something_to_do_where_it_stands_keeps_no_corridor_from_others_meanwhile(settings: Settings) -> None:
    busy = asks(GUEST, "post4", *WAY)
    done = replace(asks(GUEST, "post1", *WAY), goals=GUEST.goals[1:])
    assert verdicts(settings, busy) == []
    assert verdicts(settings, busy, done) == [MayEnter("r1", (WAY[:2], WAY[1:3]))]


def test_who_goes_home_from_another_bay_of_its_post_is_let_in(settings: Settings) -> None:
    at_home_post = replace(GUEST, post="post5", occupies=Occupied("bay", "post5_bay1"), goals=(("own", "post5"),))
    home = "post5_bay1", "post5", "post5_bay2"
    assert verdicts(settings, asks(at_home_post, "post5", *home)) == [MayEnter("r1", (home[:2], home[1:]))]


def test_who_has_left_its_corridor_is_on_the_crossing_also_before_it_says_so(settings: Settings) -> None:
    """A robot that drives through says first that it is out of the corridor, and then where it is. Ways are long, so
    that the other one would be let out before a robot that had just come in."""
    settings = settings.model_copy(update={"assumed_speed_m_s": 0.002})
    behind, ahead = Hold("post2", "post3", 1), Hold("post3", "post5", 2)
    inside = replace(GUEST, goals=(), holds=(behind, ahead), occupies=Occupied("corridor", "post2", "post3"))
    home = replace(GUEST, robot="r2", home="post4", home_bay="post4_bay2", goals=(("next", "post4"),))
    waits = replace(home, post="post3", occupies=Occupied("bay", "post3_bay1"))
    asking = asks(waits, "post4", "post3_bay1", "post3", "post4", "post4_bay1")
    there = (inside, waits)
    assert not any(isinstance(one, MayEnter) for one in verdicts(settings, there, (inside, asking)))
    out = replace(inside, holds=(ahead,))
    assert not any(isinstance(one, MayEnter) for one in verdicts(settings, there, (out, asking)))
    beyond = replace(out, occupies=Occupied("corridor", "post3", "post5"))
    assert [one.robot for one in verdicts(settings, there, (out, asking), (beyond, asking))] == ["r2"]
    assert isinstance(verdicts(settings, there, (out, asking), (beyond, asking))[0], MayEnter)
