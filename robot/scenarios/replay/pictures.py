"""A recording as PNG pictures of the map, one for every so many seconds: for slides, and for films made elsewhere."""

from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from robot.scenarios.errors import RecordingError
from robot.scenarios.replay.recording import Row, read_recording
from robot.simulated.obstacles import BUMPER_RADIUS_M

WIDTH_PX: Final = 960
EDGE_M: Final = 0.7
CARRIED_M: Final = 0.3
"""No robot drives as far between two rows: there the way has a gap."""
PAPER, TAPE, WAY, ROBOT, PERSON, INK = (
    (247, 250, 251),
    (190, 185, 180),
    (80, 170, 60),
    (180, 110, 20),
    (155, 85, 224),
    (36, 31, 28),
)
"""Blue, green, red."""
Picture = NDArray[np.uint8]


class Canvas:
    """Metres of the map to pixels: x to the right, y up."""

    def __init__(self, head: Row) -> None:
        tapes = [point for _, tape in head["map"]["corridors"] for point in tape]
        xs, ys = [x for x, _ in tapes], [y for _, y in tapes]
        self._left: float = min(xs) - EDGE_M
        self._top: float = max(ys) + EDGE_M
        self._scale: float = WIDTH_PX / (max(xs) + EDGE_M - self._left)
        self.height_px = max(1, round((self._top - min(ys) + EDGE_M) * self._scale))
        self.ground = self._ground(head)

    def at(self, x_m: float, y_m: float) -> tuple[int, int]:
        return round((x_m - self._left) * self._scale), round((self._top - y_m) * self._scale)

    def px(self, length_m: float) -> int:
        return max(2, round(length_m * self._scale))

    def _ground(self, head: Row) -> Picture:
        picture = np.full((self.height_px, WIDTH_PX, 3), PAPER, np.uint8)
        for _, tape in head["map"]["corridors"]:
            points = np.array([self.at(x, y) for x, y in tape], np.int32)
            cv2.polylines(picture, [points], False, TAPE, 2, cv2.LINE_AA)
        for name, x, y in head["map"]["posts"]:
            cv2.circle(picture, self.at(x, y), 5, INK, 1, cv2.LINE_AA)
            column, row = self.at(x, y)
            cv2.putText(picture, name, (column + 8, row - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.45, INK, 1, cv2.LINE_AA)
        return picture


def write_pictures(recording: Path, folder: Path, every_s: float) -> int:
    """Write them as 00000.png, 00001.png …; return how many. Raises RecordingError."""
    rows = read_recording(recording)
    canvas, number, due_s = Canvas(rows[0]), 0, 0.0
    ground, states = canvas.ground.copy(), dict[str, Row]()
    people, said = list[list[float]](), dict[str, str]()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RecordingError(f"{folder}: cannot be made: {error.strerror}. Give another folder.") from None
    for row in rows[1:]:
        if row["t"] >= due_s and states:
            _write(folder / f"{number:05}.png", _picture(canvas, ground, states, people, said, due_s))
            number, due_s = number + 1, due_s + every_s
        if row["kind"] == "people":
            people = row["value"]
        elif row["kind"] == "why":
            said[row["robot"]] = row["value"]
        elif row["kind"] == "state":
            before = states.get(row["robot"], row)
            if abs(before["x"] - row["x"]) + abs(before["y"] - row["y"]) < CARRIED_M:
                cv2.line(
                    ground, canvas.at(before["x"], before["y"]), canvas.at(row["x"], row["y"]), WAY, 2, cv2.LINE_AA
                )
            states[row["robot"]] = row
    return number


def _picture(
    canvas: Canvas,
    ground: Picture,
    states: dict[str, Row],
    people: list[list[float]],
    said: dict[str, str],
    at_s: float,
) -> Picture:
    picture = ground.copy()
    for x_m, y_m, radius_m in people:
        cv2.circle(picture, canvas.at(x_m, y_m), canvas.px(radius_m), PERSON, -1, cv2.LINE_AA)
    for name, state in states.items():
        place = canvas.at(state["x"], state["y"])
        ahead = (state["x"] + 0.25 * np.cos(state["heading"]), state["y"] + 0.25 * np.sin(state["heading"]))
        cv2.circle(picture, place, canvas.px(BUMPER_RADIUS_M), ROBOT, -1, cv2.LINE_AA)
        cv2.line(picture, place, canvas.at(*ahead), INK, 2, cv2.LINE_AA)
        beside = (place[0] + canvas.px(BUMPER_RADIUS_M) + 6, place[1] + 20)
        cv2.putText(picture, name, beside, cv2.FONT_HERSHEY_SIMPLEX, 0.5, ROBOT, 1, cv2.LINE_AA)
    cv2.putText(picture, f"{at_s:.1f} s", (10, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.6, INK, 1, cv2.LINE_AA)
    for number, (name, sentence) in enumerate(said.items()):
        place = (110, 24 + 22 * number)
        cv2.putText(picture, f"{name}: {sentence}", place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, INK, 1, cv2.LINE_AA)
    return picture


def _write(path: Path, picture: Picture) -> None:
    if not cv2.imwrite(str(path), picture):
        raise RecordingError(f"{path}: cannot be written. Free some room, or give another folder.")
