"""Generated pictures of codes that people show to the camera, at five sizes up to 1920 × 1080.

Each is drawn twice as fine as it comes out: a background, a phone or a sheet with the code in perspective, then glare,
light, lens, motion, the sensor's noise and the camera's JPEG, in this order. No picture is chosen by any decoder.
"""

import math
from collections.abc import Callable
from random import Random
from typing import NamedTuple

import cv2
import numpy as np
import segno
from numpy.typing import NDArray

from benchmarks.body.marker_frames import NAMES, Frame, code_modules

Colour = NDArray[np.float32]
SIZES = ((320, 240), (640, 480), (800, 600), (1280, 720), (1920, 1080))
"""Width and height in pixels."""
SAMPLES = 2
HANDOVER_SHARE = 0.75
"""Of the pictures that show a hand-over code; the others show a post's marker."""
SMALLEST_MODULE_PX = 2.5
TEXTURE_PX = 16  # of a module
NOTICE = "Please do not leave the parcel before door 2140 between Monday and Friday unless it says so here"


class ShownPicture(NamedTuple):
    """A grey picture, what was drawn into it, and on what."""

    frame: Frame
    text: str
    background: str
    size_px: tuple[int, int]


# Backgrounds, finer than they come out


def _plain(width: int, height: int, random: Random) -> Frame:
    """A painted wall, without anything on it."""
    return np.full((height, width), random.randint(40, 210), np.uint8)


def _text(width: int, height: int, random: Random) -> Frame:
    """A notice board full of print, up to its edges."""
    page = np.full((height, width), random.randint(170, 240), np.uint8)
    letter_px = height * random.uniform(0.012, 0.06)
    ink, y = random.randint(10, 70), letter_px
    while y < height + letter_px:
        line = " ".join(random.choice(NOTICE.split()) for _ in range(40))
        at = (round(-random.random() * letter_px * 4), round(y))
        weight = max(1, round(letter_px / 9))
        cv2.putText(page, line, at, cv2.FONT_HERSHEY_SIMPLEX, letter_px / 22, ink, weight, cv2.LINE_AA)
        y += letter_px * random.uniform(1.4, 1.8)
    return page


def _bricks(width: int, height: int, random: Random) -> Frame:
    """Courses of bricks, each of a tone of its own."""
    course_px = round(height * random.uniform(0.06, 0.15))
    wall = np.full((height, width), random.randint(120, 190), np.uint8)
    joint_px, tone = max(2, course_px // 12), random.randint(60, 130)
    for row, top in enumerate(range(0, height, course_px)):
        for left in range(-course_px * 2 + (row % 2) * course_px, width, course_px * 2):
            corner = (left + course_px * 2 - joint_px, top + course_px - joint_px)
            cv2.rectangle(wall, (left, top), corner, tone + random.randint(-25, 25), -1)
    return wall


def _clutter(width: int, height: int, random: Random) -> Frame:
    """Shelves, coats and posters: shades of every size with edges between them."""
    chance = np.random.default_rng(random.getrandbits(64))
    scene = np.zeros((height, width), np.float32)
    for cells in (3, 8, 24, 80):
        rough = chance.normal(0, 1, (cells, cells * 4 // 3)).astype(np.float32)
        scene += cv2.resize(rough, (width, height), interpolation=cv2.INTER_CUBIC) * 40 / math.sqrt(cells)
    picture = np.clip(scene + 110, 0, 255).astype(np.uint8)
    for _ in range(random.randint(10, 40)):
        x, y = random.randrange(width), random.randrange(height)
        wide, high = round(width * random.uniform(0.01, 0.2)), round(height * random.uniform(0.01, 0.3))
        cv2.rectangle(picture, (x, y), (x + wide, y + high), random.randrange(256), random.choice((-1, -1, 6)))
    return picture


BACKGROUNDS: dict[str, Callable[[int, int, Random], Frame]] = {
    "plain wall": _plain,
    "page of text": _text,
    "bricks": _bricks,
    "clutter": _clutter,
}


def shown_picture(number: int) -> ShownPicture:
    """The picture of this number; sizes take turns, and for each of them the backgrounds."""
    width, height = SIZES[number % len(SIZES)]
    name = list(BACKGROUNDS)[number // len(SIZES) % len(BACKGROUNDS)]
    random = Random(f"shown/{number}")
    is_handover = random.random() < HANDOVER_SHARE
    text = "CM1:" + random.randbytes(16).hex() if is_handover else random.choice(NAMES)
    modules = _handover_modules(text) if is_handover else code_modules(text)
    scene = BACKGROUNDS[name](width * SAMPLES, height * SAMPLES, random)
    sheet = _sheet(modules, random)
    module_px = _module_px(height, len(modules), random)
    warp = _warp(sheet, len(modules), module_px, (width, height), random)
    size = (width * SAMPLES, height * SAMPLES)
    cv2.warpPerspective(sheet, warp, size, scene, cv2.INTER_AREA, cv2.BORDER_TRANSPARENT)
    seen = _lit(scene.astype(np.float32), random)
    seen = _through_the_lens(seen, module_px * SAMPLES, random)
    small = cv2.resize(seen, (width, height), interpolation=cv2.INTER_AREA)
    return ShownPicture(_sensed(np.asarray(small, np.float32), random), text, name, (width, height))


def _handover_modules(text: str) -> Frame:
    made = segno.make(text, error=Random(text).choice("lmq"), micro=False)
    return np.array([list(row) for row in made.matrix], np.uint8)


def _sheet(modules: Frame, random: Random) -> Frame:
    """The code with its quiet zone, on a phone with a dark frame or on paper."""
    ink, paper = random.randint(5, 60), random.randint(170, 250)
    quiet = random.choice((2, 3, 4, 4, 4))
    code = np.where(np.pad(modules, quiet) > 0, ink, paper).astype(np.uint8)
    frame = np.pad(code, 2, constant_values=random.choice((15, paper)))
    return np.asarray(np.kron(frame, np.ones((TEXTURE_PX, TEXTURE_PX), np.uint8)))


def _module_px(height: int, modules: int, random: Random) -> float:
    """Half of the codes fill the picture, the others are as far away as they may be."""
    largest = 0.92 * height / (modules + 4)
    share = random.uniform(0.75, 1.0) if random.random() < 0.5 else random.uniform(0.2, 0.75)
    return max(SMALLEST_MODULE_PX, share * largest)


def _warp(
    sheet: Frame, modules: int, module_px: float, size_px: tuple[int, int], random: Random
) -> NDArray[np.float64]:
    """Tilted before a lens of 60°, turned as hands turn it, somewhere near the middle."""
    side, focal = sheet.shape[0] / TEXTURE_PX * module_px, size_px[0] / 2 / math.tan(math.radians(30))
    tilts = random.choice((8.0, 25.0, 45.0))
    turned, leaning = (math.radians(random.uniform(-tilts, tilts)) for _ in range(2))
    rolled = math.radians(random.choice((0, 0, 0, 90, 180, 270)) + random.gauss(0, 8))
    flat = np.array(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), float) * side / 2
    there = flat @ _about_z(rolled).T @ _about_y(turned).T @ _about_x(leaning).T
    there[:, :2] *= focal / (focal + there[:, 2:])
    free = np.maximum(0.0, (np.array(size_px) - np.ptp(there[:, :2], axis=0)) / 2)
    middle = np.array(size_px) / 2 + free * (random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8))
    seen = (there[:, :2] + middle) * SAMPLES
    end = sheet.shape[0]
    corners = np.array(((0, 0), (end, 0), (end, end), (0, end)), np.float32) - np.float32(0.5)
    return np.asarray(cv2.getPerspectiveTransform(corners, seen.astype(np.float32)))


def _about_x(angle_rad: float) -> NDArray[np.float64]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return np.array(((1, 0, 0), (0, cos, -sin), (0, sin, cos)))


def _about_y(angle_rad: float) -> NDArray[np.float64]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return np.array(((cos, 0, sin), (0, 1, 0), (-sin, 0, cos)))


def _about_z(angle_rad: float) -> NDArray[np.float64]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return np.array(((cos, -sin, 0), (sin, cos, 0), (0, 0, 1)))


def _lit(scene: Colour, random: Random) -> Colour:
    """Light that falls off to one side, and in a third of the pictures a lamp mirrored in the screen."""
    height, width = scene.shape
    across = np.linspace(1.0, 1.0 - random.uniform(0.0, 0.4), width, dtype=np.float32)[None, :]
    scene = scene * random.uniform(0.45, 1.0) * (across if random.random() < 0.5 else across[:, ::-1])
    if random.random() > 1 / 3:
        return scene
    x, y = width * random.uniform(0.3, 0.7), height * random.uniform(0.3, 0.7)
    radius = height * random.uniform(0.03, 0.15)
    rows, columns = np.ogrid[:height, :width]
    away = ((columns - x) ** 2 + (rows - y) ** 2) / radius**2
    return scene + (random.uniform(60, 260) * np.exp(-away / 2)).astype(np.float32)


def _through_the_lens(scene: Colour, module_px: float, random: Random) -> Colour:
    """Out of focus, and moved while the shutter was open, both in shares of a module."""
    blur_px = max(0.4 * SAMPLES, module_px * random.choice((0.1, 0.2, 0.35)))
    scene = np.asarray(cv2.GaussianBlur(scene, (0, 0), blur_px), np.float32)
    smear_px = round(module_px * random.choice((0.0, 0.0, 0.4, 0.9)))
    if smear_px < 2:
        return scene
    kernel = np.zeros((smear_px, smear_px), np.float32)
    angle_rad, middle = random.uniform(0, math.pi), (smear_px - 1) / 2
    way = np.array((math.cos(angle_rad), math.sin(angle_rad))) * middle
    ends = [(round(middle + sign * way[0]), round(middle + sign * way[1])) for sign in (-1, 1)]
    cv2.line(kernel, ends[0], ends[1], 1.0)
    return np.asarray(cv2.filter2D(scene, -1, kernel / kernel.sum()), np.float32)


def _sensed(scene: Colour, random: Random) -> Frame:
    """The sensor's noise, then JPEG as a camera at the end of a USB cable sends it."""
    chance = np.random.default_rng(random.getrandbits(64))
    noisy = scene + chance.normal(0, random.uniform(1, 7), scene.shape)
    grey = np.clip(noisy, 0, 255).astype(np.uint8)
    _, packed = cv2.imencode(".jpg", grey, (cv2.IMWRITE_JPEG_QUALITY, random.randint(45, 95)))
    return np.asarray(cv2.imdecode(packed, cv2.IMREAD_GRAYSCALE), np.uint8)
