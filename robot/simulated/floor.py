"""The tape on the floor and what a diode above it sees."""

import math
from collections import defaultdict
from itertools import pairwise
from random import Random

from maps import CampusMap, Point

TAPE_WIDTH_M = 0.024
CELL_M = 0.5
# A cell knows the tape this far outside itself, so that one look-up serves all diodes of a robot.
MARGIN_M = 0.1

Piece = tuple[float, float, float, float, float]  # start x, y; direction x, y; length


class Floor:
    """Where tape lies, in cells of half a metre.

    `gap_m` > 0 leaves out that much tape every 0.6 to 1.4 m, as worn tape does (seeded by `random`).
    """

    def __init__(self, campus: CampusMap, gap_m: float = 0.0, random: Random | None = None) -> None:
        self._cells: dict[tuple[int, int], list[Piece]] = defaultdict(list)
        for corridor in campus.corridors:
            for piece in _pieces(corridor.tape, gap_m, random or Random("gaps")):
                self._lay(piece)

    def _lay(self, piece: Piece) -> None:
        x, y, along_x, along_y, length = piece
        steps = max(1, math.ceil(length / MARGIN_M))
        for step in range(steps + 1):
            at_x, at_y = x + along_x * length * step / steps, y + along_y * length * step / steps
            corners = ((at_x + dx, at_y + dy) for dx in (-MARGIN_M, MARGIN_M) for dy in (-MARGIN_M, MARGIN_M))
            for cell in {_cell(*corner) for corner in corners}:
                if not self._cells[cell] or self._cells[cell][-1] is not piece:
                    self._cells[cell].append(piece)

    def near(self, x_m: float, y_m: float) -> list[Piece]:
        """The pieces of tape that can lie within MARGIN_M of here."""
        return self._cells.get(_cell(x_m, y_m), [])


def _cell(x_m: float, y_m: float) -> tuple[int, int]:
    return math.floor(x_m / CELL_M), math.floor(y_m / CELL_M)


def _pieces(tape: tuple[Point, ...], gap_m: float, random: Random) -> list[Piece]:
    """The legs of one line; the gaps run on from leg to leg, or a bend of many short ones would have none."""
    pieces, from_m = [], 0.0
    stretches = _stretches(sum(math.dist(a, b) for a, b in pairwise(tape)), gap_m, random)
    for a, b in pairwise(tape):
        length = math.dist(a, b)
        along = ((b.x_m - a.x_m) / length, (b.y_m - a.y_m) / length)
        for stretch in stretches:
            start, end = max(0.0, stretch[0] - from_m), min(length, stretch[1] - from_m)
            if start < end:
                pieces.append((a.x_m + along[0] * start, a.y_m + along[1] * start, *along, end - start))
        from_m += length
    return pieces


def _stretches(length_m: float, gap_m: float, random: Random) -> list[tuple[float, float]]:
    """From where to where tape lies on a line of this length."""
    if not gap_m:
        return [(0.0, length_m)]
    stretches, start = [], 0.0
    while start < length_m:
        end = min(start + random.uniform(0.6, 1.4), length_m)
        stretches.append((start, end))
        start = end + gap_m
    return stretches


def distance_to_tape_m(pieces: list[Piece], x_m: float, y_m: float) -> float:
    """To the middle of the nearest piece; infinite where there is none."""
    nearest = math.inf
    for start_x, start_y, along_x, along_y, length in pieces:
        dx, dy = x_m - start_x, y_m - start_y
        along = dx * along_x + dy * along_y
        beyond = along if along < 0 else (along - length if along > length else 0.0)
        across = dy * along_x - dx * along_y
        # Tape ends square, so beyond its end the distance is the larger of the two.
        distance = abs(across) if not beyond else max(abs(across), abs(beyond) + TAPE_WIDTH_M / 2)
        nearest = min(nearest, distance)
    return nearest
