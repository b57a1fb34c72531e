"""Where the robot may be, and what follows from a marker, from way driven and from a turn."""

import math
from random import Random

import pytest

from robot.localization.place import AtPost, Between, Coming, Leaving, Unknown
from robot.localization.steps import has_reached, marked, set_out, turned_round
from robot.mission.store import Store
from tests.plain_maps import plain_map
from tests.robot.agent.walk import Walk

TRACK = plain_map("test_track")
WAY = TRACK.corridor("post2", "post3")


def test_a_way_between_posts_that_are_no_neighbours_cannot_be_written_down():
    with pytest.raises(ValueError, match="post4"):
        Between(WAY, "post2", "post4")


def test_a_robot_that_sets_out_knows_by_the_map_how_far_it_is():
    place = set_out(AtPost("post2", 500.0, 480.0), WAY, WAY.length_m)
    assert place == Between(WAY, "post2", "post3", 500.0, 2500.0)
    assert set_out(AtPost("post2", 500.0, 480.0), None, 0.0) == Leaving("post2", 500.0)


def test_the_map_alone_is_no_arrival_but_a_marker_is():
    place = Between(WAY, "post2", "post3", 0.0, 2000.0)
    assert not has_reached(place, 2000.0)
    seen = marked(TRACK, place, "post3", 2060.0, 1700.0)
    assert not has_reached(seen, 2000.0)
    assert has_reached(seen, 2031.0)


def test_a_robot_that_turned_round_has_the_way_before_it_that_lay_behind_it():
    back = turned_round(Between(WAY, "post2", "post3", 0.0, 2000.0), 700.0)
    assert (back.here, back.towards, back.behind) == ("post2", "post2", "post3")
    assert back.ahead_mm == pytest.approx(1400.0)
    assert has_reached(back, 1400.0), "it knows the way that it came by"
    again = turned_round(back, 900.0)
    assert (again.towards, again.ahead_mm) == ("post3", pytest.approx(2400.0))


def test_a_marker_tells_which_of_several_lines_it_took():
    assert marked(TRACK, Leaving("post3", 0.0), "post4", 2000.0, 1700.0) == Between(
        TRACK.corridor("post3", "post4"), "post3", "post4", 0.0, 2000.0, by_marker=True
    )


def test_put_back_onto_its_way_it_is_in_the_corridor_that_it_was_in():
    lifted = Unknown("post2", frozenset({"post2", "post3"}), lifted=True)
    assert marked(TRACK, lifted, "post3", 300.0, 0.0) == Between(WAY, "post2", "post3", None, 300.0, by_marker=True)
    assert marked(TRACK, lifted, "post2", 300.0, 0.0) == Coming("post2", 300.0)


def test_short_of_a_post_it_goes_on_only_if_no_marker_has_told_how_it_stands():
    by_map = AtPost("post3", 0.0, 0.0, WAY, by_marker=False)
    assert marked(TRACK, by_map, "post3", 250.0, 0.0) == Between(WAY, "post2", "post3", None, 250.0, by_marker=True)
    sure = AtPost("post3", 0.0, 0.0, WAY)
    assert marked(TRACK, sure, "post3", 250.0, 0.0) == sure


POSTS = sorted(TRACK.posts)


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.slow
def test_whatever_it_meets_it_is_never_in_a_corridor_that_the_map_does_not_have(seed: int) -> None:
    random = Random(seed)
    with Store(None) as store:
        walk = Walk(store)
        walk.look()
        walk.navigator.place(random.choice(POSTS), None)
        for _ in range(200):
            something_happens(walk, random)
            walk.look()
            leg = walk.navigator.corridor
            assert leg is None or TRACK.corridor(leg.from_post, leg.to_post)
            assert walk.navigator.ahead_m > 0
            walk.navigator.way()
            walk.navigator.expected()


def something_happens(walk: Walk, random: Random) -> None:
    navigator, body = walk.navigator, walk.body
    deeds = (
        lambda: body.rolls(random.uniform(-300, 900)),
        lambda: body.sees(random.choice(POSTS)),
        lambda: body.turns(random.uniform(-math.pi, math.pi)),
        navigator.leave,
        navigator.begin_turn,
        navigator.turned,
        navigator.undocked,
        lambda: navigator.reached(random.choice([None, *POSTS]), random.random() < 0.3),
        lambda: body.battery(0.5, docked=random.random() < 0.2),
        lambda: body.has(*random.choice([(), (), ("wheel_drop",)])),
        lambda: setattr(navigator, "destination", random.choice(POSTS)),
        lambda: navigator.lose_place(body.view),
    )
    random.choice(deeds)()
