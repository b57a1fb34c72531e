"""The schedule of a map with bays, by pictures of the traffic: what it grants, and what it lets wait."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Final

import pytest

from app.core.settings import Settings
from app.traffic.bay_schedule import BayTrafficSchedule
from app.traffic.bays import free_bay
from app.traffic.reopening import corridor_on
from app.traffic.schedule import Elsewhere, HasToWait, MayEnter, Verdict
from app.traffic.snapshot import Hold, Occupied, ReservationRequest, RobotLocation, Stop, TrafficSnapshot
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
    goals=(Stop("stop", "post4"), Stop("next", "post1")),
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


def verdicts(
    settings: Settings,
    *pictures: RobotLocation | tuple[RobotLocation, ...],
    every_s: float = 1.0,
    silent: str | None = None,
) -> list[Verdict]:
    """On the last of these pictures. `silent`: a post without network."""
    campus = find_map(MAP)
    posts = {name: replace(post, network=name != silent) for name, post in campus.posts.items()}
    schedule, found = BayTrafficSchedule(replace(campus, posts=posts), settings), list[Verdict]()
    for number, picture in enumerate(pictures):
        robots, now_s = picture if isinstance(picture, tuple) else (picture,), number * every_s
        schedule.follow(TrafficSnapshot({one.robot: one for one in robots}, frozenset()), {}, now_s)
        found = list(schedule.verdicts({}, now_s))
    return found


WAY: Final = "post4_bay1", "post4", "post3", "post2", "post1", "post1_bay1"


def test_who_has_something_to_do_where_it_stands_keeps_no_corridor_from_others_meanwhile(settings: Settings) -> None:
    busy = asks(GUEST, "post4", *WAY)
    done = replace(asks(GUEST, "post1", *WAY), goals=GUEST.goals[1:])
    assert verdicts(settings, busy) == []
    assert verdicts(settings, busy, done) == [MayEnter("r1", (WAY[:2], WAY[1:3]))]


@pytest.mark.parametrize("goal", [Stop("own", "post5"), Stop("dock", "post5", charges_to=0.8)])
@pytest.mark.parametrize("stops", [(), (Stop("next", "post4"),), (Stop("next", "post1"), Stop("last", "post4"))])
@pytest.mark.parametrize("then", [(), ("post5", "post3", "post4", "post4_bay1")])
def test_who_goes_home_from_another_bay_of_its_post_is_let_in(
    settings: Settings, goal: Stop, stops: tuple[Stop, ...], then: tuple[str, ...]
) -> None:
    """Also when it says where it goes after that, and has work there."""
    at_home_post = replace(GUEST, post="post5", occupies=Occupied("bay", "post5_bay1"), goals=(goal, *stops))
    home = "post5_bay1", "post5", "post5_bay2"
    assert verdicts(settings, asks(at_home_post, "post5", *home, *then)) == [MayEnter("r1", (home[:2], home[1:]))]


def test_who_has_left_its_corridor_is_on_the_crossing_also_before_it_says_so(settings: Settings) -> None:
    """A robot that drives through says first that it is out of the corridor, and then where it is. Ways are long, so
    that the other one would be let out before a robot that had just come in."""
    settings = settings.model_copy(update={"assumed_speed_m_s": 0.002})
    behind, ahead = Hold("post2", "post3", 1), Hold("post3", "post5", 2)
    inside = replace(GUEST, goals=(), holds=(behind, ahead), occupies=Occupied("corridor", "post2", "post3"))
    home = replace(GUEST, robot="r2", home="post4", home_bay="post4_bay2", goals=(Stop("next", "post4"),))
    waits = replace(home, post="post3", occupies=Occupied("bay", "post3_bay1"))
    asking = asks(waits, "post4", "post3_bay1", "post3", "post4", "post4_bay1")
    there = (inside, waits)
    assert not any(isinstance(one, MayEnter) for one in verdicts(settings, there, (inside, asking)))
    out = replace(inside, holds=(ahead,))
    assert not any(isinstance(one, MayEnter) for one in verdicts(settings, there, (out, asking)))
    beyond = replace(out, occupies=Occupied("corridor", "post3", "post5"))
    assert [one.robot for one in verdicts(settings, there, (out, asking), (beyond, asking))] == ["r2"]
    assert isinstance(verdicts(settings, there, (out, asking), (beyond, asking))[0], MayEnter)


OTHER: Final = replace(
    GUEST,
    robot="r2",
    post="post5",
    home="post4",
    home_bay="post4_bay2",
    goals=(Stop("next", "post4"),),
    holds=(Hold("post5", "post3", 7),),
    occupies=Occupied("corridor", "post5", "post3"),
)
"""In the corridor before post3, on its way home to post4."""
ASKS_ON: Final = asks(OTHER, "post4", "post3", "post4", "post4_bay2")


def may_enter(settings: Settings, *pictures: tuple[RobotLocation, ...], every_s: float = 1.0) -> list[str]:
    answers = verdicts(settings, *pictures, every_s=every_s)
    return [one.robot for one in answers if isinstance(one, MayEnter)]


OUT: Final = Hold("post3_bay1", "post3", 1), Hold("post3", "post2", 2)


@pytest.mark.parametrize("news", [1, 3], ids=["at once", "later"])
def test_a_crossing_is_a_robots_until_it_says_to_be_beyond(settings: Settings, news: int) -> None:
    """From the grant on, however often the service looks, and after it has been started anew."""
    leaves = replace(
        GUEST, post="post3", goals=(Stop("next", "post2"),), occupies=Occupied("bay", "post3_bay1"), holds=OUT
    )
    assert may_enter(settings, *[(leaves, ASKS_ON)] * news) == []
    on_it = replace(leaves, occupies=Occupied("crossing", "post3"), holds=OUT[1:])
    assert may_enter(settings, *[(on_it, ASKS_ON)] * news) == []
    beyond = replace(on_it, occupies=Occupied("corridor", "post3", "post2"))
    assert may_enter(settings, (on_it, ASKS_ON), (beyond, ASKS_ON)) == ["r2"]


def test_a_crossing_is_a_robots_that_comes_in_until_it_is_in_its_bay(settings: Settings) -> None:
    into = (Hold("post3", "post3_bay1", 3),)
    comes = replace(
        GUEST, post="post3", goals=(Stop("stop", "post3"),), occupies=Occupied("crossing", "post3"), holds=into
    )
    assert may_enter(settings, (comes, ASKS_ON)) == []
    assert may_enter(settings, (comes, ASKS_ON), (comes, ASKS_ON)) == []
    stands = replace(comes, occupies=Occupied("bay", "post3_bay1"), holds=())
    assert may_enter(settings, (comes, ASKS_ON), (stands, ASKS_ON)) == ["r2"]


def test_one_before_a_crossing_on_which_another_stands_still_is_sent_back(settings: Settings) -> None:
    into = (Hold("post3", "post3_bay1", 3),)
    dead = replace(GUEST, post="post3", occupies=Occupied("crossing", "post3"), holds=into, stopped=True)
    (verdict,) = verdicts(settings, (dead, ASKS_ON))
    assert verdict == Elsewhere("r2", ("post5", "post3"))


@pytest.mark.parametrize(
    ("other", "free"),
    [
        (replace(GUEST, robot="r2", occupies=Occupied("bay", "post4_bay1")), "post4_bay2"),
        (replace(GUEST, robot="r2", holds=(Hold("post4", "post4_bay1"),), occupies=None), "post4_bay2"),
        (replace(GUEST, robot="r2", holds=(Hold("post4_bay1", "post4"),), occupies=None), "post4_bay2"),
        (replace(GUEST, robot="r2", occupies=Occupied("bay", "post3_bay1")), "post4_bay1"),
    ],
    ids=["stands in it", "was let into it", "comes out of it", "elsewhere"],
)
def test_a_bay_is_given_that_is_no_other_robots(tmp_path: Path, other: RobotLocation, free: str) -> None:
    path = tmp_path / "two_bays.toml"
    path.write_text(MAP.read_text().replace("bearing_deg = 270.0\nhome = true", "bearing_deg = 270.0"))
    track = find_map(path).track
    assert free_bay(track, "post4", GUEST, [GUEST, other], frozenset()) == free
    assert free_bay(track, "post4", GUEST, [GUEST], frozenset({"post4-post4_bay1"})) == "post4_bay2"


def test_a_spur_that_a_robot_found_blocked_can_be_opened() -> None:
    assert corridor_on(find_map(MAP), "post4-post4_bay1").b == "post4_bay1"


def test_others_do_not_wait_for_a_robot_that_charges(settings: Settings) -> None:
    """It goes to post4 when it has charged, which takes hours; the other comes from there and needs the same line."""
    to_charge, then = Stop("dock", "post5", charges_to=0.9), Stop("next", "post4")
    in_dock = Occupied("bay", "post5_bay2")
    charges = replace(GUEST, post="post5", at_home=True, occupies=in_dock, goals=(to_charge, then), battery_ratio=0.2)
    home = replace(GUEST, robot="r2", home="post4", home_bay="post4_bay2", at_home=True, goals=())
    home = replace(home, occupies=Occupied("bay", "post4_bay2"))
    comes = replace(home, goals=(Stop("load", "post5"), Stop("give", "post1")))
    way = "post4_bay2", "post4", "post3", "post5", "post5_bay1"
    leaves = asks(comes, "post5", *way)
    assert may_enter(settings, *[(charges, home)] * 3, (charges, leaves), every_s=100.0) == ["r2"]


def test_who_asks_for_a_dock_that_another_stands_in_is_not_let_onto_the_crossing(settings: Settings) -> None:
    """Its home is at another post: there is none that it could go aside to here."""
    in_dock, in_bay = Occupied("bay", "post2_bay2"), Occupied("bay", "post2_bay1")
    charges = replace(
        GUEST, robot="r2", post="post2", home="post2", home_bay="post2_bay2", at_home=True, occupies=in_dock
    )
    waits = replace(GUEST, post="post2", occupies=in_bay, goals=(Stop("own", "post2"),))
    answers = verdicts(
        settings, (replace(charges, goals=()), asks(waits, "post2", "post2_bay1", "post2", "post2_bay2"))
    )
    assert [type(one) for one in answers] == [HasToWait]


INTO, BACK = ("post4", "post4_bay1"), ("post4", "post3")


@pytest.mark.parametrize(("silent", "way_out"), [(None, ()), ("post3", ()), ("post4", (INTO[::-1], BACK))])
def test_into_a_bay_without_network_a_robot_is_let_with_its_way_out(
    settings: Settings, silent: str | None, way_out: tuple[tuple[str, str], ...]
) -> None:
    comes = replace(GUEST, holds=(Hold("post3", "post4", 1),), occupies=Occupied("corridor", "post3", "post4"))
    asking = asks(comes, "post4", *INTO)
    assert verdicts(settings, comes, asking, silent=silent) == [MayEnter("r1", (INTO, *way_out))]


def test_none_is_let_over_a_crossing_without_network_before_who_stands_there_has_been_heard(settings: Settings) -> None:
    """It says nothing more from there: not when it crosses, nor when it is in its bay or on its way back."""
    there = Hold("post4", "post4_bay1", 2), Hold("post4_bay1", "post4", 3), Hold("post4", "post3", 4)
    holds = (Hold("post3", "post4", 1), *there)
    silent = replace(GUEST, online=False, holds=holds, occupies=Occupied("corridor", "post3", "post4"))
    goals = (Stop("stop", "post4"),)
    other = replace(GUEST, robot="r2", post="post3", goals=goals, occupies=Occupied("bay", "post3_bay1"))
    asking = asks(other, "post4", "post3_bay1", "post3", "post4", "post4_bay1")
    back = replace(silent, online=True, occupies=Occupied("corridor", "post4", "post3"))
    for pictures in (((silent, asking),), ((silent, other), (back, asking))):
        found = verdicts(settings, *pictures, silent="post4")
        assert not any("post4" in leg for one in found if isinstance(one, MayEnter) for leg in one.legs)
