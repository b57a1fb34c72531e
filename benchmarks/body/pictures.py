"""Codes that people show, at every size of camera: read by the robot's decoder beside plain zxing-cpp.

Truth is what was drawn: a picture counts as read only if the drawn text comes out. Each picture is looked at in its own
size, and those larger than 640 × 480 once more shrunk to fit that.
"""

from collections.abc import Callable, Sequence
from statistics import median
from typing import Any, NamedTuple

import cv2
import numpy as np
import zxingcpp

from benchmarks.body.marker_frames import Frame
from benchmarks.body.report import Samples, Wanted, say
from benchmarks.body.shown_pictures import BACKGROUNDS, SIZES, ShownPicture, shown_picture
from benchmarks.body.vision import plain_zxing, rounded, timed
from robot.drivers.camera.qr_decoders import Decoded, may_hold_code, zxing_decoder

PICTURES_A_SEED = len(SIZES) * len(BACKGROUNDS)
SMALL_PX = (640, 480)

WANTED = (
    Wanted("native.share_of_plain", at_least=0.97, unit="of the pictures that plain zxing-cpp reads"),
    Wanted("shrunk.share_of_plain", at_least=0.97, unit="of the pictures that plain zxing-cpp reads"),
    Wanted("native.refused_share", at_most=0.0, unit="of the pictures, by the gate before the decoder"),
    Wanted("wrong", at_most=0, unit="pictures out of which another text was read"),
)


class Look(NamedTuple):
    """One picture, looked at in one size by both decoders."""

    picture: ShownPicture
    ours: frozenset[str]
    plain: frozenset[str]
    ours_ms: float
    plain_ms: float
    refused: bool

    @property
    def read(self) -> bool:
        return self.picture.text in self.ours

    @property
    def read_by_plain(self) -> bool:
        return self.picture.text in self.plain


def measure(samples: Samples) -> dict[str, Any]:
    numbers = [seed * PICTURES_A_SEED + place for seed in samples.some_seeds() for place in range(PICTURES_A_SEED)]
    decode = zxing_decoder(zxingcpp)
    native, shrunk = [], []
    for picture in map(shown_picture, numbers):
        native.append(_looked(picture, picture.frame, decode))
        shrunk.append(_looked(picture, _shrunk(picture.frame), decode))
    wrong = sum(bool(look.ours - {look.picture.text}) for look in native + shrunk)
    figures = {"pictures": len(numbers), "native": _figures(native), "shrunk": _figures(shrunk), "wrong": wrong}
    figures["sizes"] = {
        f"{width}x{height}": _figures([look for look in native if look.picture.size_px == (width, height)])
        for width, height in SIZES
    }
    figures["backgrounds"] = {
        name: _figures([look for look in native if look.picture.background == name]) for name in BACKGROUNDS
    }
    say("  " + ", ".join(f"{name} {figures[name]['read']:.1%} of {len(numbers)}" for name in ("native", "shrunk")))
    return figures


def _looked(picture: ShownPicture, frame: Frame, decode: Callable[[Frame], tuple[Decoded, ...]]) -> Look:
    ours, ours_ms = timed(decode, frame)
    plain, plain_ms = timed(plain_zxing, frame)
    return Look(picture, frozenset(ours), frozenset(plain), ours_ms, plain_ms, not may_hold_code(frame))


def _shrunk(frame: Frame) -> Frame:
    height, width = frame.shape
    scale = min(1.0, SMALL_PX[0] / width, SMALL_PX[1] / height)
    return np.asarray(cv2.resize(frame, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)


def _figures(looks: Sequence[Look]) -> dict[str, float]:
    by_plain = [look for look in looks if look.read_by_plain]
    times_ms = [look.ours_ms for look in looks]
    return {
        "read": rounded(sum(look.read for look in looks) / len(looks)),
        "read_by_plain": rounded(len(by_plain) / len(looks)),
        "share_of_plain": rounded(sum(look.read for look in by_plain) / max(1, len(by_plain))),
        "refused_share": rounded(sum(look.refused for look in looks) / len(looks)),
        "median_ms": rounded(median(times_ms)),
        "p99_ms": rounded(float(np.quantile(times_ms, 0.99))),
        "plain_median_ms": rounded(median(look.plain_ms for look in looks)),
    }
