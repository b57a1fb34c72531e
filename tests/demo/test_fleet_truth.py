"""What robots report is compared with where the simulated world has them."""

import math
from typing import Any

import pytest

from demo.fleet.truth import agreement, on_track, true_places
from maps import CampusMap, builtin_map
from maps.geometry import Point, moved, point_along
from robot.simulated import TruePose


@pytest.fixture(scope="module")
def campus() -> CampusMap:
    return builtin_map("carleton")


def standing(point: Point) -> TruePose:
    return TruePose(1.0, point.x_m, point.y_m, 0.0)


def reported(kind: str, place: str, towards: str | None = None) -> dict[str, Any]:
    return {"kind": kind, "place": place, "towards": towards}


def beside(campus: CampusMap, post: str, bay: str, ahead_m: float) -> TruePose:
    """On the spur of a bay, so far from the post."""
    place = campus.post(post)
    (spur,) = (one for one in place.spurs if one.name == bay)
    return standing(moved(place.point, spur.bearing_rad, ahead_m))


def in_corridor(campus: CampusMap, a: str, b: str, after_m: float) -> TruePose:
    return standing(point_along(campus.corridor(a, b).tape_from(a), after_m))


def test_a_pose_is_drawn_at_its_part_of_the_spur_or_corridor(campus: CampusMap) -> None:
    half = on_track(campus, beside(campus, "uc", "uc_bay2", 0.7))
    assert (half.a, half.b, half.part) == ("uc", "uc_bay2", pytest.approx(0.7))
    docked = on_track(campus, beside(campus, "uc", "uc_bay1", 1.5))
    assert (docked.b, docked.part, docked.beside_m) == ("uc_bay1", 1.0, pytest.approx(0.5))
    around_the_bend = campus.corridor("southam", "junction")
    at = on_track(campus, in_corridor(campus, "southam", "junction", 0.8 * around_the_bend.length_m))
    assert ({at.a, at.b}, at.part) == ({"southam", "junction"}, pytest.approx(0.8 if at.a == "southam" else 0.2))
    aside = on_track(campus, standing(Point(125.3, 10.0)))
    assert aside.beside_m == pytest.approx(0.3)


def test_a_body_is_in_its_bay_on_its_crossing_or_in_its_corridor(campus: CampusMap) -> None:
    assert true_places(campus, beside(campus, "uc", "uc_bay1", 1.5)) == {("bay", "uc_bay1")}
    assert true_places(campus, beside(campus, "uc", "uc_bay1", 0.3)) == {("bay", "uc_bay1"), ("crossing", "uc")}
    assert true_places(campus, in_corridor(campus, "uc", "canal", 20.0)) == {("corridor", "canal-uc")}
    assert true_places(campus, in_corridor(campus, "uc", "canal", 0.4)) == {
        ("corridor", "canal-uc"),
        ("crossing", "uc"),
    }


@pytest.mark.parametrize(
    ("told", "says"),
    [
        (reported("corridor", "uc", "canal"), "agrees"),
        (reported("corridor", "canal", "uc"), "agrees"),
        (reported("crossing", "uc"), "moving"),
        (reported("crossing", "nicol"), "differs"),
        (reported("bay", "canal_bay1"), "differs"),
        (reported("corridor", "uc", "azrieli"), "differs"),
        (None, None),
    ],
)
def test_a_report_agrees_or_is_of_the_place_before_or_differs(
    campus: CampusMap, told: dict[str, Any] | None, says: str | None
) -> None:
    assert agreement(campus, told, in_corridor(campus, "uc", "canal", 20.0)) == says


def test_who_comes_out_of_a_bay_is_moving_and_who_is_in_another_differs(campus: CampusMap) -> None:
    out = in_corridor(campus, "uc", "canal", 0.4)
    assert agreement(campus, reported("bay", "uc_bay1"), out) == "moving"
    assert agreement(campus, reported("bay", "uc_bay1"), beside(campus, "uc", "uc_bay2", 1.0)) == "differs"
    assert agreement(campus, reported("corridor", "uc", "uc_bay2"), beside(campus, "uc", "uc_bay2", 1.0)) == "agrees"
    assert math.isclose(on_track(campus, out).beside_m, 0.0, abs_tol=1e-6)
