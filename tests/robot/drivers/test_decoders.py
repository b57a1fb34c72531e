"""The robot's two decoders: what they read of unkind frames, and what they must never read.

The frames are those of `benchmarks/body/vision.py`, a few of each; the benchmark takes hundreds.
"""

from collections.abc import Callable

import numpy as np
import pytest
import zxingcpp

from benchmarks.body.foreign_frames import KINDS, foreign
from benchmarks.body.marker_frames import CONDITIONS, NAMES, Condition, shot
from benchmarks.body.shown_pictures import BACKGROUNDS, SIZES, shown_picture
from robot.drivers.camera.marker_reader import MarkerReader
from robot.drivers.camera.qr_decoders import may_hold_code, read_with_opencv, zxing_decoder
from robot.drivers.interfaces import Frame

BY_ZXING = MarkerReader(NAMES, decode=zxing_decoder(zxingcpp))
# The budget of time is for the robot; here others use the machine too.
BY_OPENCV = MarkerReader(NAMES, decode=lambda frame: read_with_opencv(frame, budget_s=2.0))
EACH = 8


def condition(name: str) -> Condition:
    return next(one for one in CONDITIONS if one.name == name)


def read(reader: MarkerReader, name: str, seeds: range) -> int:
    shots = [shot(condition(name), seed) for seed in seeds]
    return sum([sighting.text for sighting in reader.look(one.frame, 0.0)] == [one.post] for one in shots)


@pytest.mark.parametrize("name", ["clean", "small", "motion", "tilt", "low_light", "tunnel"])
@pytest.mark.nightly
def test_zxing_reads_small_blurred_dark_and_slanting_markers(name: str):
    assert read(BY_ZXING, name, range(9000, 9000 + EACH)) >= EACH - 1


@pytest.mark.parametrize("name", ["clean", "small"])
def test_without_zxing_clean_and_small_markers_are_read(name: str):
    assert read(BY_OPENCV, name, range(9100, 9100 + EACH)) >= EACH - 1


def test_a_code_that_is_partly_outside_the_picture_is_read_as_nothing_or_as_itself():
    for seed in range(9200, 9210):
        one = shot(condition("cut"), seed)
        assert {sighting.text for sighting in BY_ZXING.look(one.frame, 0.0)} <= {one.post}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.nightly
def test_nothing_comes_out_of_what_is_not_ours(kind: str):
    place = list(KINDS).index(kind)
    for round_number in range(5000, 5024):
        what, frame = foreign(round_number * len(KINDS) + place)
        assert what == kind
        assert BY_ZXING.look(frame, 0.0) == ()
        if round_number % 8 == 0:
            assert BY_OPENCV.look(frame, 0.0) == ()


@pytest.mark.parametrize("size", [(480, 640), (120, 160), (3, 3), (1080, 1920)])
@pytest.mark.parametrize("fill", [np.zeros, np.ones])
def test_a_frame_without_anything_is_not_looked_at(size: tuple[int, int], fill: Callable[..., Frame]):
    frame = fill(size, np.uint8)
    assert not may_hold_code(frame)
    assert BY_ZXING.look(frame, 0.0) == ()


@pytest.mark.parametrize("size", [(240, 320), (480, 640), (1080, 1920)])
@pytest.mark.parametrize("grain", [1.0, 4.0, 9.0, 16.0])
def test_grain_alone_is_not_taken_for_a_code(grain: float, size: tuple[int, int]):
    chance = np.random.default_rng(int(grain))
    frame = np.clip(chance.normal(70, grain, size), 0, 255).astype(np.uint8)
    assert not may_hold_code(frame)


def test_every_frame_with_a_marker_is_looked_at():
    assert all(may_hold_code(shot(one, seed).frame) for one in CONDITIONS for seed in range(9300, 9304))


@pytest.mark.parametrize("size_px", SIZES)
@pytest.mark.nightly
def test_codes_shown_by_people_are_read_at_every_size_and_before_everything(size_px: tuple[int, int]):
    """On a wall, over a page of text, before bricks and clutter; half of the codes fill the picture."""
    first = 9000 + SIZES.index(size_px)
    decode, readable = zxing_decoder(zxingcpp), 0
    for picture in map(shown_picture, range(first, first + 2 * len(SIZES) * len(BACKGROUNDS), len(SIZES))):
        assert picture.size_px == size_px
        assert may_hold_code(picture.frame), picture.background
        if picture.text in {code.text for code in zxingcpp.read_barcodes(picture.frame)}:
            readable += 1
            assert picture.text in {code.text for code in decode(picture.frame)}, picture.background
    assert readable >= len(BACKGROUNDS)
