"""Place and angle from a marker's corners, beside the truth of the simulated world."""

import math
import statistics
from itertools import product

import pytest

from robot.drivers.camera.marker_pose import Optics, code_pose
from robot.drivers.camera.marker_reader import MarkerReader
from robot.drivers.interfaces import Sighting
from robot.simulated import CameraMount
from robot.simulated.faults import Faults
from robot.simulated.frames import Renderer, View
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")
MARKERS = tuple(marker for post in TRACK.posts.values() for marker in post.markers)
READER = MarkerReader(TRACK.posts)


def seen(back_mm: float, beside_mm: float, turned_deg: float, darkness: float = 0.0, seed: int = 0) -> Sighting:
    """post1's marker stands 350 mm to the left of a robot at (0, 3.7) that looks north."""
    drawn = Renderer(MARKERS, CameraMount(colour=False), Faults(darkness=darkness), seed)
    view = View(beside_mm / 1000, 3.7 - back_mm / 1000, math.pi / 2 + math.radians(turned_deg))
    (sighting,) = READER.look(drawn.frame(view), 0.0)
    assert sighting.text == "post1"
    return sighting


def truth(back_mm: float, beside_mm: float, turned_deg: float) -> tuple[float, float]:
    """(ahead, left) of the marker in the robot's own frame."""
    turned, left_mm = math.radians(turned_deg), 350 + beside_mm
    along, across = math.cos(turned), math.sin(turned)
    return back_mm * along + left_mm * across, left_mm * along - back_mm * across


POSES = [(back, beside, turned) for back, beside, turned in product((-60, 0, 60), (-40, 0, 150), (-8, 0, 8))]


@pytest.mark.parametrize(("darkness", "seed"), [(0.0, 1), (0.7, 2)])
def test_the_place_is_true_to_2_mm_and_the_angle_to_half_a_degree_mostly_to_four_always(darkness: float, seed: int):
    away, angle = [], []
    for pose in POSES:
        sighting, (ahead_mm, left_mm) = seen(*pose, darkness, seed), truth(*pose)
        away.append(math.hypot(sighting.ahead_mm - ahead_mm, sighting.left_mm - left_mm))
        angle.append(abs(math.degrees(sighting.turned_rad) - pose[2]))
    assert statistics.median(away) < 1.0 and max(away) < 2.0, away
    assert statistics.median(angle) < 0.6 and max(angle) < 4.0, angle


def test_it_says_how_far_it_is_to_be_trusted():
    near, far = seen(0, 0, 0), seen(0, 350, 0)
    assert 1.0 <= near.accuracy_mm < far.accuracy_mm < 5.0
    assert near.accuracy_rad < far.accuracy_rad < math.radians(5)


@pytest.mark.parametrize("turned_deg", [-35, -20, 20, 35])
def test_from_aslant_the_sign_of_the_angle_is_right_too(turned_deg: float):
    """The robot stands so that the marker is in the middle of the picture."""
    left_mm = 400 * math.cos(math.radians(turned_deg))
    back_mm = -400 * math.sin(math.radians(turned_deg))
    sighting = seen(back_mm, left_mm - 350, turned_deg)
    assert math.degrees(sighting.turned_rad) == pytest.approx(turned_deg, abs=1.5)
    assert (sighting.ahead_mm, sighting.left_mm) == pytest.approx((0, 400), abs=3)


def test_corners_that_no_flat_sheet_has_give_no_pose():
    crossed = ((10.0, 10.0), (90.0, 90.0), (90.0, 10.0), (10.0, 90.0))
    nowhere = ((math.nan, 10.0), (90.0, 10.0), (90.0, 90.0), (10.0, 90.0))
    frame = Renderer(MARKERS, CameraMount(colour=False), Faults(), 0).frame(View(0.0, 3.7, math.pi / 2))
    assert code_pose(frame, "post1", crossed, 80.0, Optics()) is None
    assert code_pose(frame, "post1", nowhere, 80.0, Optics()) is None


def test_where_the_pattern_does_not_fit_the_decoders_corners_are_all_there_is():
    """The denser pattern of a longer name over this picture: the place is rougher, and said to be."""
    frame = Renderer(MARKERS, CameraMount(colour=False), Faults(), 0).frame(View(0.0, 3.7, math.pi / 2))
    corners = ((257.0, 177.0), (383.0, 177.0), (383.0, 303.0), (257.0, 303.0))
    own, others = (code_pose(frame, post, corners, 80.0, Optics()) for post in ("post1", "a_long_name"))
    assert own and others
    assert others.accuracy_mm > 2 * own.accuracy_mm
    assert others.away_mm == pytest.approx(350, abs=8)
