"""Generated pictures of marker sheets, 640 × 480, for eight conditions of growing unkindness.

A sheet stands upright before a camera of 60° as `design` has it: the page in true perspective, three samples a pixel in
each direction, then what optics, motion, light and sensor do to it, in this order. The numbers were chosen so that
plain zxing-cpp and QRCodeDetector fare on these frames as on those the project was planned with, or worse (`PLANNED` in
`vision.py`; within a few of 100). OpenCV's Aruco variant fares better here with dirt and in the tunnel.
"""

import math
from dataclasses import dataclass
from random import Random
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from maps import builtin_map
from maps.sheets import marker_code

Frame = NDArray[np.uint8]
WIDTH, HEIGHT, SAMPLES = 640, 480, 3
FOCAL_PX = WIDTH / 2 / math.tan(math.radians(30))
MODULES, CODE_MM = 21, 80.0
PAGE_MM = (148.0, 210.0)
CODE_AT_MM = (34.0, 50.0)  # of the page, from its left and its top
TEXTURE_PX = 12  # of a module
VERSION_1 = 7  # characters that fit version 1 at error correction H
NAMES = tuple(
    sorted(
        {name for campus in ("test_track", "carleton") for name in builtin_map(campus).posts if len(name) <= VERSION_1}
    )
)


@dataclass(frozen=True, slots=True)
class Condition:
    """One way to spoil a sheet. A pair is drawn evenly between its two numbers, anew for every frame."""

    name: str
    px_per_module: tuple[float, float] = (5.7, 6.3)
    turned_deg: tuple[float, float] = (-8.0, 8.0)
    """Of the page about the upright; positive or negative by chance where `either_way`."""
    either_way: bool = False
    leaning_deg: tuple[float, float] = (-3.0, 3.0)
    """Of the picture: sheets are glued by hand and floors are not level."""
    defocus_px: tuple[float, float] = (0.3, 0.5)
    """Standard deviation of the lens' blur."""
    motion_modules: tuple[float, float] = (0.0, 0.0)
    """Way of the picture along its rows while the shutter is open."""
    paper: tuple[float, float] = (190.0, 225.0)
    ink: tuple[float, float] = (20.0, 40.0)
    shade: tuple[float, float] = (0.0, 0.2)
    """How much darker one side of the picture is than the other."""
    noise: tuple[float, float] = (2.0, 4.0)
    """Standard deviation of the sensor's noise in grey levels."""
    dirt: float = 0.0
    """Share of the code under blots."""
    cut: float = 0.0
    """Share of the code that is beyond the left or right edge of the picture."""


CONDITIONS = (
    Condition("clean"),
    Condition("small", px_per_module=(2.9, 3.1)),
    Condition("motion", motion_modules=(1.45, 1.55)),
    Condition("low_light", paper=(38.0, 60.0), ink=(9.0, 15.0), noise=(9.0, 12.0)),
    Condition("tilt", px_per_module=(4.8, 5.8), turned_deg=(43.0, 47.0), either_way=True, defocus_px=(0.5, 0.7)),
    Condition("cut", cut=0.05, turned_deg=(-2.0, 2.0), leaning_deg=(-1.0, 1.0)),
    Condition("dirt", dirt=0.06),
    Condition(
        "tunnel",
        px_per_module=(4.0, 6.0),
        turned_deg=(5.0, 25.0),
        either_way=True,
        defocus_px=(0.5, 0.8),
        motion_modules=(0.1, 0.4),
        paper=(80.0, 130.0),
        ink=(15.0, 30.0),
        shade=(0.2, 0.4),
        noise=(3.5, 6.5),
        dirt=0.008,
    ),
)


def shot(condition: Condition, seed: int) -> "Shot":
    """The frame of this seed; the same seed gives another sheet in each condition."""
    random = Random(f"{condition.name}/{seed}")
    noise = np.random.default_rng(random.getrandbits(64))
    post = random.choice(NAMES)
    paper, ink = random.uniform(*condition.paper), random.uniform(*condition.ink)
    page = _page(marked(code_modules(post), condition, random), paper, ink)
    module_px = random.uniform(*condition.px_per_module)
    place = _placed(condition, module_px, random)
    picture = _wall(paper, random)
    warp = cv2.getPerspectiveTransform(
        _page_corners(page), (place(PAGE_CORNERS_MM) * SAMPLES + (SAMPLES - 1) / 2).astype(np.float32)
    )
    cv2.warpPerspective(
        page, warp, (WIDTH * SAMPLES, HEIGHT * SAMPLES), picture, cv2.INTER_LINEAR, cv2.BORDER_TRANSPARENT
    )
    picture = _seen_through(picture, condition, module_px, random)
    grey = cv2.resize(picture, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA).astype(np.float32)
    grey *= _light(random.uniform(*condition.shade), random)
    grey += noise.normal(0.0, random.uniform(*condition.noise), grey.shape)
    return Shot(np.clip(grey, 0, 255).astype(np.uint8), post, place)


def code_modules(post: str) -> Frame:
    """1 for every dark module, 21 × 21."""
    return np.array([list(row) for row in marker_code(post).matrix], np.uint8)


def _page_corners(page: Frame) -> NDArray[np.float32]:
    height, width = page.shape
    return np.array(((0, 0), (width, 0), (width, height), (0, height)), np.float32) - np.float32(0.5)


def _rectangle(left: float, top: float, width: float, height: float) -> NDArray[np.float64]:
    """Corners in millimetres from the middle of the code, right and down."""
    left, top = left - CODE_AT_MM[0] - CODE_MM / 2, top - CODE_AT_MM[1] - CODE_MM / 2
    return np.array(((left, top), (left + width, top), (left + width, top + height), (left, top + height)))


PAGE_CORNERS_MM = _rectangle(0, 0, *PAGE_MM)
CODE_CORNERS_MM = _rectangle(*CODE_AT_MM, CODE_MM, CODE_MM)


class Placed(NamedTuple):
    """A page before the lens: from millimetres on it to pixels. Positive `turned_rad`: its right edge is farther."""

    away_mm: float
    right_mm: float
    down_mm: float
    turned_rad: float
    leaning_rad: float

    def __call__(self, points_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        along, down = points_mm[:, 0], points_mm[:, 1]
        away = self.away_mm + along * math.sin(self.turned_rad)
        x, y = (along * math.cos(self.turned_rad) + self.right_mm) / away, (down + self.down_mm) / away
        cos, sin = math.cos(self.leaning_rad), math.sin(self.leaning_rad)
        rows, columns = FOCAL_PX * (x * sin + y * cos), FOCAL_PX * (x * cos - y * sin)
        return np.stack((columns + (WIDTH - 1) / 2, rows + (HEIGHT - 1) / 2), axis=1)


class Shot(NamedTuple):
    """A frame, the post its marker names, and where its page was before the lens."""

    frame: Frame
    post: str
    placed: Placed

    @property
    def corners(self) -> NDArray[np.float64]:
        """Of the code: top left, then clockwise, in pixels from the middle of the first one."""
        return self.placed(CODE_CORNERS_MM)


def _placed(condition: Condition, module_px: float, random: Random) -> Placed:
    turned_deg = random.uniform(*condition.turned_deg) * (random.choice((-1, 1)) if condition.either_way else 1)
    away_mm = FOCAL_PX * CODE_MM / MODULES / module_px
    mm_per_px = away_mm / FOCAL_PX
    right_px, down_px = random.uniform(-120, 120), random.uniform(-40, 40)
    if condition.cut:
        right_px = random.choice((-1, 1)) * (WIDTH / 2 + (condition.cut - 0.5) * MODULES * module_px)
    leaning_rad = math.radians(random.uniform(*condition.leaning_deg))
    return Placed(away_mm, right_px * mm_per_px, down_px * mm_per_px, math.radians(turned_deg), leaning_rad)


def _page(code: NDArray[np.float32], paper: float, ink: float) -> Frame:
    """`code` from 0 (paper) to 1 (ink), on its page with a line of print above."""
    px_per_mm = len(code) / CODE_MM
    width, height = (round(side * px_per_mm) for side in PAGE_MM)
    print_on = np.zeros((height, width), np.uint8)
    left, top = (round(side * px_per_mm) for side in CODE_AT_MM)
    cv2.putText(print_on, "CAMPUS MAIL", (left, 30 * len(code) // 80), cv2.FONT_HERSHEY_SIMPLEX, px_per_mm / 3, 1, 6)
    page = print_on.astype(np.float32)
    page[top : top + len(code), left : left + len(code)] = code
    return np.asarray(paper + (ink - paper) * page, np.uint8)


def marked(modules: Frame, condition: Condition, random: Random) -> NDArray[np.float32]:
    """The code with its dirt."""
    code = np.kron(modules, np.ones((TEXTURE_PX, TEXTURE_PX))).astype(np.float32)
    size, covered = len(code), np.zeros(code.shape, np.uint8)
    while condition.dirt and covered.mean() < condition.dirt:
        blot = np.zeros(code.shape, np.uint8)
        centre = random.randrange(size), random.randrange(size)
        axes = random.randint(size // 60, size // 30), random.randint(size // 60, size // 30)
        cv2.ellipse(blot, centre, axes, random.uniform(0, 180), 0, 360, 1, -1)
        thickness, tone = random.uniform(0.5, 0.9), random.choice((0.1, 0.5, 0.9))
        code += blot * thickness * (tone - code)
        covered |= blot
    return code


def _wall(paper: float, random: Random) -> Frame:
    """Painted brick in the same light as the paper, with a pipe or a cable here and there."""
    wall = np.full((HEIGHT * SAMPLES, WIDTH * SAMPLES), paper * random.uniform(0.35, 0.6), np.float32)
    for _ in range(random.randint(2, 6)):
        ends = [(random.randrange(WIDTH * SAMPLES), random.randrange(HEIGHT * SAMPLES)) for _ in range(2)]
        cv2.line(wall, ends[0], ends[1], paper * random.uniform(0.1, 0.9), random.randint(3, 40))
    return np.asarray(wall, np.uint8)


def _seen_through(picture: Frame, condition: Condition, module_px: float, random: Random) -> Frame:
    """The lens, then the way of the picture over the sensor."""
    picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), random.uniform(*condition.defocus_px) * SAMPLES), np.uint8)
    smear = round(random.uniform(*condition.motion_modules) * module_px * SAMPLES)
    return np.asarray(cv2.blur(picture, (smear, 1)), np.uint8) if smear > 1 else picture


def _light(shade: float, random: Random) -> NDArray[np.float32]:
    """Brighter on one side: a lamp is never where it should be."""
    across = np.linspace(1.0, 1.0 - shade, WIDTH, dtype=np.float32)[None, :]
    return across if random.random() < 0.5 else across[:, ::-1]
