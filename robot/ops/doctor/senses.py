"""The senses: three diodes and a camera."""

import time
from collections.abc import Iterator

import numpy as np

from robot.core.config import ConfigError
from robot.core.errors import RobotError
from robot.core.line_pins import PIN_NAMES, PinWatch, open_pins
from robot.drivers.camera.qr_decoders import best_decoder
from robot.drivers.interfaces import Camera, Frame
from robot.ops.doctor.findings import Finding, Subjects, fail, ok, skip, warn

LOOK_S = 1.0
FEWEST_CHANGES = 2
"""Onto the tape and off it again."""
RESTLESS_PER_S = 20.0
CAMERA_S, FIRST_FRAME_S = 2.0, 5.0
FEWEST_FPS = 8.0
DARK, BRIGHT = 25.0, 235.0


def pins(patient: Subjects) -> Finding:
    """Check whether the diodes can be read; with --push, whether each sees the tape come and go."""
    if patient.daemon is not None:
        return skip("the running daemon holds the pins")
    try:
        devices = open_pins(patient.settings.line, patient.equipment.pin_factory())
    except ConfigError as problem:
        return fail(problem.message, problem.way_out)
    except Exception as error:  # gpiozero and lgpio have errors of their own for pins that are taken or do not exist
        return fail(f"the pins cannot be used: {error}", "Does another program use them? Are line.…_pin right?")
    try:
        return _pushed(patient, PinWatch(devices)) if patient.push_s else _standing(PinWatch(devices))
    finally:
        for device in devices:
            device.close()


def _standing(watch: PinWatch) -> Finding:
    watch.look(LOOK_S)
    said = ", ".join(f"{name} {share:.0%} high" for name, share in zip(PIN_NAMES, watch.high_shares, strict=True))
    if max(watch.changes) > RESTLESS_PER_S * LOOK_S:
        return warn(f"flickering while the robot stands: {said}", "Mind the height over the floor, and stray light.")
    return ok(f"{said}; with --push a person can push the robot over the tape")


def _pushed(patient: Subjects, watch: PinWatch) -> Finding:
    if not patient.equipment.simulated:
        patient.tell(f"Push the robot over the tape and back, to and fro, for {patient.push_s:g} s.")
    with patient.equipment.pushed():
        watch.look(patient.push_s, lambda: min(watch.changes) >= FEWEST_CHANGES)
    counts = list(zip(PIN_NAMES, watch.changes, strict=True))
    said = ", ".join(f"{name} changed {count} times" for name, count in counts)
    dead = [name for name, count in counts if count < FEWEST_CHANGES]
    if dead:
        way_out = "Check its wire, its pin (setting line.…_pin) and its height over the floor."
        return fail(f"the tape does not show on the {' and the '.join(dead)} diode: {said}", way_out)
    return ok(said)


def camera(patient: Subjects) -> Finding:
    """Check whether it opens, delivers, sees enough light, and reads a marker that is before it."""
    if patient.daemon is not None:
        return skip("the running daemon holds the camera")
    try:
        device = patient.equipment.open_camera()
    except RobotError as problem:
        return fail(str(problem), "v4l2-ctl --list-devices shows what there is.")
    try:
        frames = list(_frames(device, patient.patience))
    finally:
        device.close()
    return _judged(patient, frames)


def _frames(device: Camera, patience: float) -> Iterator[tuple[float, Frame]]:
    """With the time each came. The first may take seconds."""
    until_s = time.monotonic() + FIRST_FRAME_S * patience
    first = True
    while (now := time.monotonic()) < until_s:
        there_is_one, frame = device.read()
        if there_is_one and frame is not None:
            if first:
                first, until_s = False, now + CAMERA_S * patience
            yield now, frame
        time.sleep(0.01)


def _judged(patient: Subjects, frames: list[tuple[float, Frame]]) -> Finding:
    if len(frames) < 2:
        return fail("it opens, but delivers no pictures", "Check its cable; is another program using it?")
    rate = (len(frames) - 1) / (frames[-1][0] - frames[0][0])
    newest = frames[-1][1]
    height, width = newest.shape[:2]
    light = float(np.mean(newest))
    texts = {code.text for _, frame in frames[-3:] for code in best_decoder()(frame)}
    said = f"{width}×{height}, {rate:.0f} frames/s, mean light {light:.0f} of 255, " + _seen(patient, texts)
    wanted = patient.settings.camera
    if (width, height) != (wanted.width_px, wanted.height_px):
        return fail(f"{said}; {wanted.width_px}×{wanted.height_px} are set", "Set camera.width_px and height_px.")
    if all(np.array_equal(newest, frame) for _, frame in frames):
        return fail(f"{said}: always the same picture", "Pull the camera's plug and put it in again.")
    if rate < FEWEST_FPS:
        return fail(f"{said}: too few", "More light, a shorter exposure, or another camera.")
    if not DARK <= light <= BRIGHT:
        return warn(f"{said}: too {'dark' if light < DARK else 'bright'} to read a marker", "See camera.exposure_ms.")
    return ok(said)


def _seen(patient: Subjects, texts: set[str]) -> str:
    return f"reads {', '.join(sorted(texts))}" if texts else "no marker before it (hold one 0.3 m off to see it read)"
