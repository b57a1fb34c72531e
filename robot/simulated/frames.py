"""The simulated camera's view: frames from the robot's left side, 254 mm above the floor, looking left.

The marker sheets are those that `python -m maps markers` prints, seen in true perspective; people stand before them,
or hold a hand-over code in front of the camera. What is not worth drawing is a dim wall with noise, drawn once.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain
from random import Random
from typing import Any

import cv2
import numpy as np
import segno
from numpy.typing import NDArray

from maps import Marker
from maps.sheets import (
    CODE_LEFT_MM,
    CODE_TOP_MM,
    PAGE_HEIGHT_MM,
    PAGE_WIDTH_MM,
    TAG_LEFT_MM,
    TAG_TOP_MM,
    marker_code,
    tag_cells,
)
from maps.tags import TAG_SIZE_MM
from robot.simulated.faults import Faults
from robot.simulated.obstacles import BASE_HEIGHT_M, BOX_HEIGHT_M, BOX_RADIUS_M, BUMPER_RADIUS_M, Obstacle

BACKGROUNDS = 4
Frame = NDArray[np.uint8]

CODE_MM = 80
PX_PER_MODULE = (4, 8, 16)  # textures of a sheet: the renderer takes the nearest that is not finer than twice the view
SEEN_FROM_M, SEEN_TO_M = 0.08, 1.5
QUIET_MODULES = 4
SHOWN_SHARE = 1 / 60
"""Side of a module of a code held up, of the picture's height; a code of many modules is drawn smaller, see below."""
LARGEST_SHOWN_SHARE = 0.92
"""Of the picture's height, quiet zone included."""
TEXTURE_PX_PER_MODULE = 8
WALL, PAPER, INK, CLOTHES = 96, 225, 25, 55
PEOPLE_TO_M = 2.5  # farther off they are part of the wall


@dataclass(frozen=True)
class CameraMount:
    """Where the lens is, from the middle of the axle, and what it sees; `exposure_s` blurs what moves."""

    ahead_m: float = 0.0
    left_m: float = 0.0
    height_m: float = 0.254
    across_rad: float = math.radians(60)
    exposure_s: float = 0.008
    noise: float = 4.0
    colour: bool = True
    april_tags: bool = False
    """Whether the sheets were printed with tags."""
    width_px: int = 640
    height_px: int = 480

    @property
    def focal_px(self) -> float:
        return self.width_px / 2 / math.tan(self.across_rad / 2)


@dataclass(frozen=True)
class View:
    """Where the robot is and how it moves while the shutter is open."""

    x_m: float
    y_m: float
    heading_rad: float
    speed_m_s: float = 0.0
    turning_rad_s: float = 0.0


class Renderer:
    """Frames of one robot's camera."""

    def __init__(
        self,
        markers: tuple[Marker, ...],
        mount: CameraMount,
        faults: Faults,
        seed: int,
        tags: Mapping[str, int] | None = None,
        obstacles: Callable[[], Iterable[Obstacle]] = tuple,
        robots: Callable[[], Iterable[Obstacle]] = tuple,
    ) -> None:
        """`tags` holds the number of each post's AprilTag. People among the `obstacles`, and `robots`, hide what is
        behind them."""
        self._markers, self._tags, self._obstacles, self._robots = markers, tags or {}, obstacles, robots
        self._seed = seed
        self._mount = mount
        self._faults = faults
        self._random = Random(f"{seed}/camera")
        self.size_px = mount.width_px, mount.height_px
        self._walls = _walls(mount.noise, seed, self.size_px)
        self._noise = _noise(mount.noise, seed, self.size_px)
        self._sheets: dict[tuple[Marker | str, int], Frame] = {}
        self._shown: dict[str, tuple[Frame, ...]] = {}
        self._chosen: Frame | None = None
        # Post or single marker → share that is covered, beside what the switch `dirt` covers of all of them.
        self.dirt: Mapping[Any, float] = {}

    def frame(self, view: View, shown: str | None = None) -> Frame:
        """Height × width, BGR as OpenCV's cameras give it, or grey. `shown` is a text held up as a QR code."""
        grey = self._marker_frame(view) if shown is None else self._other(self._held_up(shown))
        if self._faults.darkness:
            grey = _darker(grey, self._faults.darkness)
        if self._mount.colour:
            return np.asarray(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), np.uint8)
        return grey.copy()

    def _other(self, pictures: tuple[Frame, ...]) -> Frame:
        """No sensor gives the same picture twice."""
        self._chosen = self._random.choice([one for one in pictures if one is not self._chosen])
        return self._chosen

    def _marker_frame(self, view: View) -> Frame:
        """Objects farther off are drawn first."""
        frame = self._other(self._walls)
        in_view: list[tuple[float, Marker, NDArray[np.float32]] | tuple[float, _InView, None]] = []
        for marker in self._markers:
            corners = sheet_corners(marker, view, self._mount)
            if corners is not None:
                in_view.append((_seen(marker.x_m, marker.y_m, view, self._mount)[0], marker, corners))
        standing = chain(_people(self._obstacles(), view), _bodies(self._robots(), view))
        in_view += [(one.away_m, one, None) for one in _in_view(standing, view, self._mount)]
        if not in_view:
            return frame
        frame = frame.copy()
        for _, thing, place in sorted(in_view, key=lambda one: -one[0]):
            if isinstance(thing, _InView):
                self._draw_dark(frame, thing)
            elif place is not None:
                self._draw(frame, thing, place, view)
        return frame

    def _draw_dark(self, frame: Frame, one: "_InView") -> None:
        part = frame[one.top_px : one.floor_px, one.left_px : one.right_px]
        if not part.size:
            return
        row, column = self._random.randrange(64), self._random.randrange(64)
        noise = self._noise[row : row + part.shape[0], column : column + part.shape[1]]
        part[:] = cv2.add(np.full(part.shape, CLOTHES, np.uint8), noise, dtype=cv2.CV_8U)

    def _draw(self, frame: Frame, marker: Marker, corners: NDArray[np.float32], view: View) -> None:
        left, top = np.maximum(np.floor(corners.min(axis=0)).astype(int) - 8, 0)
        right, bottom = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 8, self.size_px)
        if right - left < 2 or bottom - top < 2:
            return
        sheet = self._sheet(marker, float(np.linalg.norm(corners[1] - corners[0])))
        height, width = sheet.shape
        texture = np.array(((0, 0), (width, 0), (width, height), (0, height)), np.float32) - 0.5
        seen = corners - np.array((left, top), np.float32) - 0.5
        warp = cv2.getPerspectiveTransform(texture, seen.astype(np.float32))
        part = frame[top:bottom, left:right]
        size = (int(right - left), int(bottom - top))
        cv2.warpPerspective(sheet, warp, size, dst=part, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_TRANSPARENT)
        self._soften(part, marker, view)
        row, column = self._random.randrange(64), self._random.randrange(64)
        noise = self._noise[row : row + size[1], column : column + size[0]]
        part[:] = cv2.add(part, noise, dtype=cv2.CV_8U)

    def _soften(self, part: Frame, marker: Marker, view: View) -> None:
        """Smear what moves while the shutter is open along the picture's rows."""
        distance_m = max(_seen(marker.x_m, marker.y_m, view, self._mount)[0], 0.05)
        px_per_s = self._mount.focal_px * (abs(view.speed_m_s) / distance_m + abs(view.turning_rad_s))
        smear = round(px_per_s * self._mount.exposure_s)
        if smear > 1:
            cv2.blur(part, (smear, 1), dst=part)

    def _sheet(self, marker: Marker, width_px: float) -> Frame:
        """The printed page as a texture, coarse enough that drawing it smaller does not alias."""
        post = marker.post
        fitting = [size for size in PX_PER_MODULE if _page_px(post, size) <= 2 * width_px]
        px_per_module = max(fitting, default=PX_PER_MODULE[0])
        dirt = max(self._faults.dirt, self.dirt.get(marker, 0.0), self.dirt.get(post, 0.0))
        key = (marker if dirt else post, px_per_module)
        if key not in self._sheets:
            page = _page(post, px_per_module, self._tags.get(post))
            if dirt:
                # The same spots at every size, whenever it is seen first.
                _make_dirty(page, dirt, Random(f"{self._seed}/dirt/{marker}"))
            self._sheets[key] = page
        return self._sheets[key]

    def forget_sheets(self) -> None:
        """Draw the pages anew: they got dirty, or were wiped."""
        self._sheets.clear()

    def _held_up(self, text: str) -> tuple[Frame, ...]:
        if text not in self._shown:
            self._shown = {text: tuple(_held_up(text, wall, self._random) for wall in self._walls)}
        return self._shown[text]


def _seen(x_m: float, y_m: float, view: View, mount: CameraMount) -> tuple[float, float]:
    """(distance along the camera's axis, right of it), in metres. The camera looks to the robot's left."""
    along, across = math.cos(view.heading_rad), math.sin(view.heading_rad)
    dx, dy = x_m - view.x_m, y_m - view.y_m
    ahead, left = dx * along + dy * across - mount.ahead_m, dy * along - dx * across - mount.left_m
    return left, ahead


def sheet_corners(marker: Marker, view: View, mount: CameraMount) -> NDArray[np.float32] | None:
    """Where the page's corners (top left, top right, bottom right, bottom left) are in the picture; None if unseen."""
    away_m, right_m = _seen(marker.x_m, marker.y_m, view, mount)
    if not SEEN_FROM_M < away_m < SEEN_TO_M or abs(right_m) > away_m + marker.size_m:
        return None
    # Facing it, the printed left edge is on the viewer's left: along the face, turned right.
    face = marker.heading_rad
    if math.cos(face - (view.heading_rad + math.pi / 2)) > -0.1:
        return None
    per_mm = marker.size_m / 80
    rightward_x, rightward_y = -math.sin(face) * per_mm, math.cos(face) * per_mm
    edges_mm = (-CODE_LEFT_MM - 40, PAGE_WIDTH_MM - CODE_LEFT_MM - 40)
    heights_mm = (CODE_TOP_MM + 40, CODE_TOP_MM + 40 - PAGE_HEIGHT_MM)
    columns = []
    for edge in edges_mm:
        away, right = _seen(marker.x_m + rightward_x * edge, marker.y_m + rightward_y * edge, view, mount)
        if away < SEEN_FROM_M / 2:
            return None
        columns.append((away, right))
    return _projected(columns, [height * per_mm + 0.254 - mount.height_m for height in heights_mm], mount)


def _projected(columns: list[tuple[float, float]], heights_m: list[float], mount: CameraMount) -> NDArray[np.float32]:
    middle_x, middle_y, focal_px = mount.width_px / 2, mount.height_px / 2, mount.focal_px
    order = ((0, 0), (1, 0), (1, 1), (0, 1))
    return np.array(
        [
            (middle_x + focal_px * columns[c][1] / columns[c][0], middle_y - focal_px * heights_m[r] / columns[c][0])
            for c, r in order
        ],
        np.float32,
    )


@lru_cache
def _modules(code: str, error: str) -> NDArray[np.uint8]:
    """1 for every dark module. Making a code costs milliseconds, so it is kept."""
    made = marker_code(code) if error == "h" else segno.make(code, error=error, micro=False)
    return np.array([list(row) for row in made.matrix], np.uint8)


def _page_px(post: str, px_per_module: int) -> float:
    return len(_modules(post, "h")) * px_per_module * PAGE_WIDTH_MM / 80


def _page(post: str, px_per_module: int, tag: int | None) -> Frame:
    code = _code_picture(_modules(post, "h"), px_per_module, quiet=0)
    px_per_mm = code.shape[0] / CODE_MM
    page = np.full((round(PAGE_HEIGHT_MM * px_per_mm), round(PAGE_WIDTH_MM * px_per_mm)), PAPER, np.uint8)
    left, top = round(CODE_LEFT_MM * px_per_mm), round(CODE_TOP_MM * px_per_mm)
    page[top : top + code.shape[0], left : left + code.shape[1]] = code
    if tag is not None:
        left, top, size = (round(mm * px_per_mm) for mm in (TAG_LEFT_MM, TAG_TOP_MM, TAG_SIZE_MM))
        cells = np.where(np.array(tag_cells(tag)), INK, PAPER).astype(np.uint8)
        page[top : top + size, left : left + size] = cv2.resize(cells, (size, size), interpolation=cv2.INTER_NEAREST)
    return page


def _make_dirty(page: Frame, share: float, random: Random) -> None:
    """Grey spots on the code until about this share of it is covered; a spot is about two modules wide."""
    px_per_mm = page.shape[1] / PAGE_WIDTH_MM
    size, radius_mm = CODE_MM * px_per_mm, CODE_MM * 0.05
    radius = max(2, round(radius_mm * px_per_mm))
    for _ in range(round(share * CODE_MM * CODE_MM / (math.pi * radius_mm * radius_mm))):
        x, y = CODE_LEFT_MM * px_per_mm + random.random() * size, CODE_TOP_MM * px_per_mm + random.random() * size
        cv2.circle(page, (round(x), round(y)), radius, random.randrange(40, 200), -1)


@dataclass(frozen=True)
class _InView:
    """A person or a part of a robot in the picture: how far away, from which column to which, from which row to the
    floor."""

    away_m: float
    left_px: int
    right_px: int
    top_px: int
    floor_px: int


Cylinder = tuple[float, float, float, float]  # x, y; radius; height


def _people(obstacles: Iterable[Obstacle], view: View) -> Iterator[Cylinder]:
    """To beyond the upper edge: the lens is at the height of a knee. Walls are part of the background."""
    for one in obstacles:
        x_m, y_m, radius_m = one.nearest(view.x_m, view.y_m)
        if radius_m:
            yield x_m, y_m, radius_m, math.inf


def _bodies(robots: Iterable[Obstacle], view: View) -> Iterator[Cylinder]:
    for one in robots:
        x_m, y_m, _ = one.nearest(view.x_m, view.y_m)
        yield x_m, y_m, BUMPER_RADIUS_M, BASE_HEIGHT_M
        yield x_m, y_m, BOX_RADIUS_M, BOX_HEIGHT_M


def _in_view(standing: Iterable[Cylinder], view: View, mount: CameraMount) -> Iterator[_InView]:
    for x_m, y_m, radius_m, height_m in standing:
        away_m, right_m = _seen(x_m, y_m, view, mount)
        if not radius_m + SEEN_FROM_M / 2 < away_m < PEOPLE_TO_M:
            continue
        middle, half = math.atan2(right_m, away_m), math.asin(radius_m / math.hypot(away_m, right_m))
        left, right = (
            mount.width_px / 2 + mount.focal_px * math.tan(max(-1.4, min(1.4, edge)))
            for edge in (middle - half, middle + half)
        )
        if right > 0 and left < mount.width_px:
            columns = max(0, round(left)), min(mount.width_px, round(right))
            yield _InView(away_m - radius_m, *columns, _row(height_m, away_m, mount), _row(0.0, away_m, mount))


def _row(height_m: float, away_m: float, mount: CameraMount) -> int:
    """The picture's row in which something so high above the floor is seen."""
    row = mount.height_px / 2 - mount.focal_px * (height_m - mount.height_m) / away_m
    return round(min(max(row, 0.0), mount.height_px))


def _code_picture(modules: NDArray[np.uint8], px_per_module: int, quiet: int) -> Frame:
    ink = np.where(np.pad(modules, quiet) > 0, INK, PAPER).astype(np.uint8)
    return np.kron(ink, np.ones((px_per_module, px_per_module), np.uint8))


def _held_up(text: str, wall: Frame, random: Random) -> Frame:
    """A phone's screen with the code, a little turned and never twice in the same place."""
    height, width = wall.shape
    code = _code_picture(_modules(text, "m"), TEXTURE_PX_PER_MODULE, QUIET_MODULES)
    size = code.shape[0]
    module_px = min(height, width * 3 / 4) * min(SHOWN_SHARE, LARGEST_SHOWN_SHARE * TEXTURE_PX_PER_MODULE / size)
    turn = cv2.getRotationMatrix2D((size / 2, size / 2), random.uniform(-6, 6), module_px / TEXTURE_PX_PER_MODULE)
    turn[0, 2] += width / 2 - size / 2 + random.uniform(-1, 1) * width / 32
    turn[1, 2] += height / 2 - size / 2 + random.uniform(-1, 1) * height / 60
    frame = wall.copy()
    cv2.warpAffine(code, turn, (width, height), dst=frame, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_TRANSPARENT)
    return frame


@lru_cache(maxsize=4)
def _walls(noise: float, seed: int, size_px: tuple[int, int]) -> tuple[Frame, ...]:
    """A dim wall above a darker floor, with the sensor's noise."""
    width, height = size_px
    random = np.random.default_rng(seed)
    rows = np.linspace(WALL + 20, WALL - 20, height)[:, None] * np.ones((1, width))
    rows[int(height * 0.8) :] -= 30
    return tuple(
        np.clip(rows + random.normal(0, noise, (height, width)), 0, 255).astype(np.uint8) for _ in range(BACKGROUNDS)
    )


@lru_cache(maxsize=4)
def _noise(noise: float, seed: int, size_px: tuple[int, int]) -> NDArray[np.int16]:
    """A little larger than a frame, so that a random part of it is always new."""
    width, height = size_px
    random = np.random.default_rng(seed + 1)
    return random.normal(0, noise, (height + 64, width + 64)).astype(np.int16)


def _darker(frame: Frame, share: float) -> Frame:
    return np.asarray(cv2.convertScaleAbs(frame, alpha=1.0 - share), np.uint8)
