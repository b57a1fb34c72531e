"""Markers out of rendered frames: read, checked, measured; and nothing foreign ever gets through."""

import math
import random
from collections.abc import Callable

import cv2
import numpy as np
import pytest
import segno
import zxingcpp
from hypothesis import given, settings
from hypothesis import strategies as st

from robot.drivers.camera.marker_reader import MarkerReader, MarkerWatch
from robot.drivers.camera.qr_decoders import Decoded, Decoder, read_with_opencv, zxing_decoder
from robot.drivers.interfaces import Frame
from robot.simulated import Pose, SimulatedRobot
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")
DECODERS: list[Decoder] = [zxing_decoder(zxingcpp), read_with_opencv]
either_decoder = pytest.mark.parametrize("decode", DECODERS, ids=["zxing", "opencv"])


def frame_of(text: str, px_per_module: int = 6, at: tuple[int, int] = (200, 130), error: str = "h") -> Frame:
    """A code on a dim wall, 480 × 640."""
    rows = np.array([list(row) for row in segno.make(text, error=error, micro=False).matrix], np.uint8)
    code = np.where(np.kron(np.pad(rows, 4), np.ones((px_per_module, px_per_module))) > 0, 30, 220).astype(np.uint8)
    frame = np.full((480, 640), 120, np.uint8)
    left, top = at
    frame[top : top + code.shape[0], left : left + code.shape[1]] = code
    return frame


def seen_from(ahead_m: float, post: str = "post2") -> Frame:
    """Return what the camera sees of post2's marker, `ahead_m` before it is abreast on the way from post1."""
    robot = SimulatedRobot(TRACK, 0.0, "post1:post2", in_memory=True)
    robot.place(Pose(0.0, 2.3 + ahead_m, -math.pi / 2))
    there_is_one, frame = robot.camera.read()
    robot.close()
    assert there_is_one and frame is not None
    return frame


@either_decoder
def test_a_posts_marker_is_read(decode: Decoder):
    (sighting,) = MarkerReader(TRACK.posts, decode=decode).look(frame_of("post3"), 7.0)
    assert (sighting.text, sighting.at_s) == ("post3", 7.0)


@either_decoder
def test_what_is_no_post_of_the_map_is_foreign(decode: Decoder):
    reader = MarkerReader(TRACK.posts, decode=decode)
    assert reader.look(frame_of("https://example.org"), 0.0) == ()
    assert reader.look(frame_of("post33"), 0.0) == ()
    assert reader.look(frame_of("POST3"), 0.0) == ()


@either_decoder
def test_a_handover_code_passes_on_whatever_its_number(decode: Decoder):
    code = "CM1:" + "5a" * 16
    (sighting,) = MarkerReader(TRACK.posts, decode=decode).look(frame_of(code, 5, (150, 60), "m"), 0.0)
    assert sighting.text == code


@either_decoder
def test_a_torn_code_is_nothing(decode: Decoder):
    frame = frame_of("post3")
    frame[:, 200 : 200 + 100] = 120
    assert MarkerReader(TRACK.posts, decode=decode).look(frame, 0.0) == ()


@pytest.mark.parametrize("ahead_mm", [150, 60, 0, -60, -150])
def test_where_the_marker_is_comes_out_within_a_centimetre(ahead_mm: float):
    (sighting,) = MarkerReader(TRACK.posts).look(seen_from(ahead_mm / 1000), 0.0)
    assert sighting.text == "post2"
    assert sighting.ahead_mm == pytest.approx(ahead_mm, abs=12)
    assert sighting.left_mm == pytest.approx(350, abs=15)


def test_a_decoder_that_fails_does_not_take_the_robot_down():
    class Broken:
        BarcodeFormat = zxingcpp.BarcodeFormat

        @staticmethod
        def read_barcodes(*_: object, **__: object) -> list[object]:
            raise RuntimeError("torn finder pattern")

    assert MarkerReader(TRACK.posts, decode=zxing_decoder(Broken)).look(frame_of("post3"), 0.0) == ()


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1), text=st.text(min_size=1, max_size=30))
@pytest.mark.nightly
def test_no_foreign_code_crashes_the_ladder_or_is_taken_for_a_post(seed: int, text: str):
    frame = frame_of(text, 4, (60, 40), "l")
    noise = np.random.default_rng(seed)
    frame[noise.integers(0, 480, 300), noise.integers(0, 640, 300)] = noise.integers(0, 256, 300)
    for decode in DECODERS:
        found = MarkerReader(TRACK.posts, decode=decode).look(frame, 0.0)
        assert all(sighting.text == text for sighting in found)


def test_the_ladder_reads_what_its_first_rung_cannot():
    plain, missed, saved = cv2.QRCodeDetector(), 0, 0
    for number in range(12):
        shift = random.Random(number).randint(0, 30)
        frame = cv2.GaussianBlur(frame_of("post3", 3, (200 + shift, 150)), (0, 0), 1.1)
        if not plain.detectAndDecode(frame)[0]:
            missed += 1
            saved += any(code.text == "post3" for code in read_with_opencv(frame, budget_s=1.0))
    if missed:
        assert saved / missed >= 0.5, f"{saved} of {missed}"
    else:
        assert read_with_opencv(frame_of("post3", 3))[0].text == "post3"


class Album:
    """A camera that shows one picture after the other."""

    def __init__(self, *frames: Frame | None) -> None:
        self._frames = list(frames)

    def read(self) -> tuple[bool, Frame | None]:
        frame = self._frames.pop(0)
        return frame is not None, frame

    def close(self) -> None:
        """Nothing to free."""


def reads(*texts: str | None) -> Callable[[Frame], tuple[Decoded, ...]]:
    waiting = iter(texts)
    corners = ((300.0, 200.0), (340.0, 200.0), (340.0, 240.0), (300.0, 240.0))
    return lambda _: tuple(Decoded(text, corners) for text in (next(waiting),) if text)


def accepted(*texts: str | None) -> list[str | None]:
    blank = np.zeros((480, 640), np.uint8)
    watch = MarkerWatch(Album(*[blank] * len(texts)), MarkerReader(TRACK.posts, decode=reads(*texts)))
    reports = [watch.tick(float(number)) for number in range(len(texts))]
    return [report.posts[0].text if report.posts else None for report in reports]


def test_two_equal_reads_of_three_accept():
    assert accepted("post3", "post3", None, None) == [None, "post3", None, None]
    assert accepted("post3", None, "post3") == [None, None, "post3"]
    assert accepted("post3", None, None, "post3") == [None, None, None, None]


def test_one_misread_post_among_others_is_not_believed():
    assert accepted("post3", "post3", "post4", "post3") == [None, "post3", None, "post3"]


def test_a_camera_that_gives_no_frame_grows_old():
    watch = MarkerWatch(Album(frame_of("post3"), None, None), MarkerReader(TRACK.posts), now=0.0)
    ages = [watch.tick(now).frame_age_s for now in (1.0, 1.5, 2.4)]
    assert ages == pytest.approx([0.0, 0.5, 1.4])


def test_a_handover_code_is_in_no_log():
    code = "CM1:" + "5a" * 16
    (sighting,) = MarkerReader(TRACK.posts).look(frame_of(code, 5, (150, 60), "m"), 0.0)
    assert sighting.text == code
    assert "5a" not in f"{sighting!r} {sighting}"
    assert "post3" in repr(MarkerReader(TRACK.posts).look(frame_of("post3"), 0.0))


def test_what_is_far_too_long_for_a_code_of_ours_is_foreign():
    frame = frame_of("CM1:" + "x" * 300, 5, (20, 20), "l")
    assert MarkerReader(TRACK.posts, decode=zxing_decoder(zxingcpp)).look(frame, 0.0) == ()


def test_a_watch_is_a_position_source_that_tells_each_fix_once():
    frame = seen_from(0.05)
    watch = MarkerWatch(Album(*(frame + np.uint8(n) for n in range(3))), MarkerReader(TRACK.posts))
    told = []
    for now in (1.0, 1.1, 1.2):
        watch.tick(now)
        told.append([(fix.source, fix.post, fix.at_s) for fix in watch.fixes(now)])
    assert told == [[], [("marker", "post2", 1.1)], [("marker", "post2", 1.2)]]
    assert watch.fixes(2.0) == ()


def test_the_same_picture_again_is_no_second_read_and_its_age_is_told():
    watch = MarkerWatch(Album(*[frame_of("post3")] * 4), MarkerReader(TRACK.posts))
    reports = [watch.tick(now) for now in (1.0, 1.1, 1.6, 2.2)]
    assert [report.posts for report in reports] == [()] * 4
    assert [report.frozen_s for report in reports] == pytest.approx([0.0, 0.1, 0.6, 1.2])


def test_pictures_of_the_dark_may_be_equal():
    black = np.full((480, 640), 3, np.uint8)
    watch = MarkerWatch(Album(*[black] * 3), MarkerReader(TRACK.posts))
    assert [watch.tick(float(now)).frozen_s for now in range(3)] == [0.0] * 3
