"""Markers decoded on generated frames, and how long it takes: the robot's two decoders beside OpenCV's plain ones.

Every frame goes through the robot's own functions, as they run on the robot; what counts as decoded is the right post's
name after the check against the map. Foreign and torn codes have to come to nothing.
"""

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from statistics import median
from textwrap import fill
from typing import Any

import cv2
import numpy as np
import zxingcpp

from benchmarks.body.foreign_frames import KINDS, foreign
from benchmarks.body.marker_frames import CONDITIONS, NAMES, Condition, Frame, shot
from benchmarks.body.report import Samples, Wanted, say
from robot.drivers.camera.marker_reader import HANDOVER_PREFIX, MarkerReader
from robot.drivers.camera.qr_decoders import Decoded, Decoder, may_hold_code, read_with_opencv, zxing_decoder

FRAMES_A_SEED = 10
FOREIGN_A_SEED = 150
LADDER_SHARE = 5
"""One of so many foreign frames also goes up the OpenCV ladder, which takes forty times as long."""
PERCENT = "share of frames"

WANTED = (
    *(Wanted(f"zxing.{name}.decoded", at_least=0.95, unit=PERCENT) for name in ("clean", "small", "motion", "tilt")),
    Wanted("zxing.tunnel.decoded", at_least=0.95, unit=PERCENT),
    Wanted("zxing.low_light.decoded", at_least=0.90, unit=PERCENT),
    Wanted("zxing.median_ms", at_most=3.0, unit="ms, over all frames"),
    Wanted("opencv_ladder.clean.decoded", at_least=0.95, unit=PERCENT),
    Wanted("opencv_ladder.small.decoded", at_least=0.95, unit=PERCENT),
    Wanted("foreign.crashed", at_most=0, unit="frames"),
    Wanted("foreign.accepted", at_most=0, unit="frames"),
    Wanted("wrong_posts", at_most=0, unit="frames read as another post"),
)

# Decoded, of 100, and median ms, as the design has them for others' decoders on its own frames: what ours are compared
# with. (OpenCV's QRCodeDetector, its Aruco variant, zxing-cpp as it comes.)
PLANNED = {
    "clean": ((100, 8.7), (94, 7.8), (100, 0.6)),
    "small": ((65, 8.7), (52, 7.9), (100, 0.6)),
    "motion": ((52, 12), (10, 9), (100, 0.6)),
    "low_light": ((24, 10), (17, 15), (96, 1.8)),
    "tilt": ((88, 9), (86, 8), (98, 0.6)),
    "cut": ((0, 0), (0, 0), (0, 0)),
    "dirt": ((62, 9), (40, 4), (78, 0.6)),
    "tunnel": ((82, 9), (56, 8), (96, 1.1)),
}


def measure(samples: Samples) -> dict[str, Any]:
    decoders = _decoders()
    figures: dict[str, Any] = {name: {} for name in decoders}
    times: dict[str, list[float]] = {name: [] for name in decoders}
    wrong, unseen = 0, 0
    numbers = [seed * FRAMES_A_SEED + number for seed in samples.some_seeds() for number in range(FRAMES_A_SEED)]
    for condition in CONDITIONS:
        shots = [shot(condition, number) for number in numbers]
        unseen += sum(not may_hold_code(one.frame) for one in shots)
        for name, decode in decoders.items():
            reads = [timed(decode, one.frame) for one in shots]
            right = sum(one.post in texts for one, (texts, _) in zip(shots, reads, strict=True))
            wrong += sum(bool(texts & set(NAMES) - {one.post}) for one, (texts, _) in zip(shots, reads, strict=True))
            took_ms = [ms for _, ms in reads]
            times[name] += took_ms
            figures[name][condition.name] = {"decoded": right / len(shots), "median_ms": rounded(median(took_ms))}
        say(f"  {condition.name}: " + ", ".join(_said(name, figures[name][condition.name]) for name in decoders))
    for name, all_ms in times.items():
        figures[name] |= {"median_ms": rounded(median(all_ms)), "p99_ms": rounded(float(np.quantile(all_ms, 0.99)))}
    figures |= {"wrong_posts": wrong, "not_looked_at": unseen, "frames_per_condition": len(numbers)}
    figures |= {"foreign": _foreign(samples), "planned": PLANNED}
    _plot(samples.plots, figures, numbers[0])
    return figures


def _decoders() -> dict[str, Decoder]:
    """Ours by both ways, and what others offer as it comes."""
    return {
        "zxing": zxing_decoder(zxingcpp),
        "opencv_ladder": read_with_opencv,
        "plain_zxing": plain_zxing,
        "plain_opencv": _plain(cv2.QRCodeDetector()),
        "plain_opencv_aruco": _plain(cv2.QRCodeDetectorAruco()),
    }


def plain_zxing(frame: Frame) -> tuple[Decoded, ...]:
    found = zxingcpp.read_barcodes(frame, formats=zxingcpp.BarcodeFormat.QRCode)
    return tuple(Decoded(code.text, ((0, 0), (0, 0), (0, 0), (0, 0))) for code in found)


def _plain(detector: Any) -> Decoder:
    def read(frame: Frame) -> tuple[Decoded, ...]:
        try:
            text = detector.detectAndDecode(frame)[0]
        except (cv2.error, UnicodeDecodeError):
            return ()
        return (Decoded(text, ((0, 0), (0, 0), (0, 0), (0, 0))),) if text else ()

    return read


def timed(decode: Callable[[Frame], tuple[Decoded, ...]], frame: Frame) -> tuple[set[str], float]:
    """Return what was read, and processor time in ms: others use the machine too."""
    began_s = time.thread_time()
    found = decode(frame)
    return {code.text for code in found}, (time.thread_time() - began_s) * 1000


def _said(name: str, figure: Mapping[str, float]) -> str:
    return f"{name} {figure['decoded']:.0%} {figure['median_ms']:g} ms"


def rounded(value: float) -> float:
    return float(f"{value:.3g}")


# Foreign and torn codes


def _foreign(samples: Samples) -> dict[str, Any]:
    """`accepted` counts frames out of which anything came: a post's name, or something that begins like our codes."""
    readers = {
        "zxing": MarkerReader(NAMES, decode=zxing_decoder(zxingcpp)),
        "opencv_ladder": MarkerReader(NAMES, decode=read_with_opencv),
    }
    counted = {"frames": 0, "crashed": 0, "accepted": 0}
    kinds = dict.fromkeys(KINDS, 0)
    first = samples.first_seed * FOREIGN_A_SEED
    for number in range(first, first + samples.seeds * FOREIGN_A_SEED):
        kind, frame = foreign(number)
        kinds[kind] += 1
        for name, reader in readers.items():
            if name == "opencv_ladder" and (number // len(KINDS)) % LADDER_SHARE:
                continue
            counted["frames"] += 1
            try:
                found = reader.look(frame, 0.0)
            except Exception as error:
                say(f"  {name} crashed on {kind} {number}: {error!r}")
                counted["crashed"] += 1
                continue
            if found:
                say(f"  {name} accepted {kind} {number}: {found}")
                counted["accepted"] += 1
    assert not any(name.startswith(HANDOVER_PREFIX) for name in NAMES)
    return {**counted, "kinds": kinds}


# Plots


def _plot(folder: Path, figures: Mapping[str, Any], number: int) -> None:
    import matplotlib

    matplotlib.use("Agg")
    _contact_sheet(folder / "vision_frames.png", number)
    _bars(folder / "vision_decoders.svg", figures)


def _contact_sheet(path: Path, number: int) -> None:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 4, figsize=(16, 7.4), layout="constrained")
    for condition, axis in zip(CONDITIONS, axes.flat, strict=True):
        axis.imshow(shot(condition, number).frame, cmap="gray", vmin=0, vmax=255)
        axis.set_title(
            f"{_words(condition.name)}\n{fill(_parameters(condition), 62)}", fontsize=8, loc="left", va="bottom"
        )
        axis.axis("off")
    figure.savefig(path, dpi=80)
    pyplot.close(figure)


def _parameters(condition: Condition) -> str:
    """Return what this condition has that a clean frame has not."""
    clean = CONDITIONS[0]
    names = [name for name in Condition.__slots__ if name not in {"name", "either_way"}]
    own = [name for name in names if getattr(condition, name) != getattr(clean, name)]
    return ", ".join(f"{_words(name)} {_range(getattr(condition, name))}" for name in own) or "as it comes"


def _words(name: str) -> str:
    return name.replace("px_per_module", "pixels per module").replace("_", " ")


def _range(value: object) -> str:
    return f"{value[0]:g} to {value[1]:g}" if isinstance(value, tuple) else str(value)


def _bars(path: Path, figures: Mapping[str, Any]) -> None:
    from matplotlib import pyplot

    names = [
        name for name in figures if isinstance(figures[name], dict) and "clean" in figures[name] and name != "planned"
    ]
    figure, (shares, times) = pyplot.subplots(2, 1, figsize=(11, 7), sharex=True, layout="constrained")
    width = 0.8 / len(names)
    for place, name in enumerate(names):
        at = [number + place * width for number in range(len(CONDITIONS))]
        shares.bar(at, [figures[name][one.name]["decoded"] * 100 for one in CONDITIONS], width, label=_words(name))
        times.bar(at, [figures[name][one.name]["median_ms"] for one in CONDITIONS], width)
    figure.suptitle("Generated 640×480 frames: what is read, and what that costs")
    shares.set_ylabel("decoded, %")
    figure.legend(ncols=len(names), fontsize=9, loc="outside lower center", frameon=False)
    times.set_ylabel("processor time per frame, median, ms")
    times.set_yscale("log")
    times.yaxis.set_major_formatter("{x:g}")
    times.set_xticks([number + 0.3 for number in range(len(CONDITIONS))], [_words(one.name) for one in CONDITIONS])
    for axis in (shares, times):
        axis.grid(axis="y", alpha=0.3)
        axis.set_axisbelow(True)
    figure.savefig(path)
    pyplot.close(figure)
