"""Which bay a robot takes, and what it is wholly in."""

from pathlib import Path

import pytest

from maps import find_map
from protocol.parts import Leg
from robot.localization.bays import Occupied, bay_for, evidence_of, occupied, places_to_stand
from robot.localization.place import AtPost, Between, Coming, Leaving, Place, Unknown

MAP = Path(__file__).parents[2] / "bays.toml"
TRACK = find_map(MAP).track
CORRIDOR = TRACK.corridor("post2", "post3")
SPUR = TRACK.corridor("post3", "post3_bay1")
OUTWARDS = Between(CORRIDOR, "post2", "post3", 1000.0, 3000.0)


def test_it_stands_in_bays_and_at_a_post_without_any():
    assert places_to_stand(TRACK, "post4") == ("post4_bay1", "post4_bay2")
    assert places_to_stand(TRACK, "post4_bay2") == ("post4_bay2",)


@pytest.mark.parametrize(
    ("home", "granted", "avoided", "bay"),
    [
        (None, (), frozenset(), "post4_bay1"),
        ("post4_bay2", (), frozenset(), "post4_bay2"),
        ("post4_bay2", (Leg(from_post="post4", to_post="post4_bay1"),), frozenset(), "post4_bay1"),
        (None, (Leg(from_post="post4", to_post="post3"),), frozenset(), "post4_bay1"),
        (None, (), frozenset({"post4-post4_bay1"}), "post4_bay1"),
    ],
)
def test_the_bay_is_the_one_granted_its_home_or_the_first_that_is_nobodys_home(home, granted, avoided, bay):
    assert bay_for(TRACK, "post4", home, granted, avoided) == bay


@pytest.mark.parametrize(
    ("place", "ahead_mm", "where"),
    [
        (AtPost("post4_bay1", 0.0, 0.0), 0.0, Occupied("bay", "post4_bay1")),
        (AtPost("post4", 0.0, 0.0), 0.0, Occupied("crossing", "post4")),
        (OUTWARDS, 1449.0, None),
        (OUTWARDS, 1450.0, Occupied("corridor", "post2", "post3")),
        (
            Between(CORRIDOR, "post2", "post3", None, 3000.0, by_marker=True),
            2500.0,
            Occupied("corridor", "post2", "post3"),
        ),
        (Between(CORRIDOR, "post2", "post3", None, 3000.0, by_marker=True), 2600.0, None),
        (Between(CORRIDOR, "post2", "post3", None, None), 2600.0, None),
        (Between(SPUR, "post3", "post3_bay1", 0.0, 1000.0), 900.0, None),
        (Coming("post3", 3000.0), 2500.0, None),
        (Leaving("post3", 0.0), 2500.0, None),
        (Unknown(), 0.0, None),
    ],
)
def test_it_occupies_what_its_whole_body_is_in(place: Place, ahead_mm: float, where: Occupied | None):
    assert occupied(TRACK, place, ahead_mm) == where


def test_the_evidence_is_what_told_its_place_last():
    assert evidence_of(AtPost("post4_bay1", 0.0, 0.0), 0.0) == ("marker", None)
    assert evidence_of(AtPost("post4_bay1", 0.0, 0.0, by_marker=False), 0.0) == ("map", None)
    assert evidence_of(AtPost("post5_bay2", 0.0, 0.0, docked=True), 0.0) == ("dock", None)
    assert evidence_of(OUTWARDS, 1451.6) == ("distance", 452)


def test_a_bay_that_it_found_blocked_is_left_for_the_next_one(tmp_path: Path):
    path = tmp_path / "two_bays.toml"
    path.write_text(MAP.read_text().replace("bearing_deg = 270.0\nhome = true", "bearing_deg = 270.0"))
    track = find_map(path).track
    assert bay_for(track, "post4", None, (), frozenset()) == "post4_bay1"
    assert bay_for(track, "post4", None, (), frozenset({"post4-post4_bay1"})) == "post4_bay2"
