"""Pictures out of which nothing may be read: codes of others, other symbologies, torn and scrambled ones."""

from collections.abc import Callable
from random import Random

import cv2
import numpy as np
import segno
import zxingcpp

from benchmarks.body.marker_frames import HEIGHT, NAMES, WIDTH, Frame, code_modules

LETTERS = "abcdefghijklmnopqrstuvwxyz0123456789_:/.-ABCXYZ éß≈"
SYMBOLOGIES = ("Aztec", "DataMatrix", "PDF417", "Code128", "Code39", "EAN13", "ITF", "MaxiCode", "MicroQRCode")


def _text(random: Random) -> str:
    return "".join(random.choice(LETTERS) for _ in range(random.randint(1, 60)))


def _foreign_text(random: Random) -> Frame:
    return _qr(segno.make(_text(random), micro=False, error=random.choice("lmqh")))


def _binary(random: Random) -> Frame:
    return _qr(segno.make(random.randbytes(random.randint(1, 120)), micro=False, mode="byte"))


def _eci(random: Random) -> Frame:
    """Codes that name an encoding of their own: some decoders raise on these."""
    encoding, text = random.choice((("utf-8", "né☂"), ("shift_jis", "点茗"), ("iso-8859-7", "αβγ"), ("cp1252", "€œ")))
    return _qr(segno.make_qr(text * random.randint(1, 6), encoding=encoding, eci=True))


def _kanji(random: Random) -> Frame:
    return _qr(segno.make_qr("点茗" * random.randint(1, 9), mode="kanji"))


def _not_on_the_map(random: Random) -> Frame:
    """One letter more, less or other than a post's name."""
    name = random.choice(NAMES)
    place = random.randrange(len(name))
    others = [
        name + random.choice("0aZ "),
        " " + name,
        name[:place] + name[place + 1 :],
        name[:place] + "#" + name[place:],
    ]
    return _qr(segno.make(random.choice([one for one in others if one not in NAMES]), micro=False, error="h"))


def _wrong_case(random: Random) -> Frame:
    name = random.choice(NAMES)
    return _qr(segno.make(random.choice((name.upper(), name.capitalize(), name.swapcase())), micro=False, error="h"))


def _like_a_handover_code(random: Random) -> Frame:
    start = random.choice(("cm1:", "CM2:", "CM1", "CM1;", " CM1:", "xCM1:"))
    return _qr(segno.make(start + random.randbytes(16).hex(), micro=False))


def _torn(random: Random) -> Frame:
    """A marker of ours of which a third or more is gone: too much for its error correction."""
    code = _qr(code_modules(random.choice(NAMES)))
    size, strip = len(code), random.randint(len(code) * 4 // 10, len(code) * 7 // 10)
    code = np.rot90(code, random.randrange(4)).copy()
    code[size - strip :] = random.choice((90, 220))
    return code


def _scrambled(random: Random) -> Frame:
    """The squares of a code of ours, and chance between them."""
    modules = code_modules(random.choice(NAMES)).copy()
    chance = np.random.default_rng(random.getrandbits(64)).integers(0, 2, modules.shape, np.uint8)
    modules[9:-8, :], modules[:, 9:-8] = chance[9:-8, :], chance[:, 9:-8]
    modules[9:, 9:] = chance[9:, 9:]
    return _qr(modules)


def _other_symbology(random: Random) -> Frame:
    kind = random.choice(SYMBOLOGIES)
    digits = {"EAN13": "4006381333931", "ITF": "123456", "MicroQRCode": "post1"}
    text = digits.get(kind, random.choice(NAMES).upper() if kind == "Code39" else random.choice(NAMES))
    made = zxingcpp.create_barcode(text, getattr(zxingcpp.BarcodeFormat, kind))
    return np.array(zxingcpp.write_barcode_to_image(made, scale=4), np.uint8)


def _noise(random: Random) -> Frame:
    blocks = np.random.default_rng(random.getrandbits(64)).integers(0, 256, (60, 80), np.uint8)
    return np.kron(blocks, np.ones((4, 4), np.uint8))


KINDS: dict[str, Callable[[Random], Frame]] = {
    "foreign text": _foreign_text,
    "binary": _binary,
    "encoding named": _eci,
    "kanji": _kanji,
    "not on the map": _not_on_the_map,
    "wrong case": _wrong_case,
    "almost a hand-over code": _like_a_handover_code,
    "torn": _torn,
    "scrambled": _scrambled,
    "other symbology": _other_symbology,
    "noise": _noise,
}


def foreign(number: int) -> tuple[str, Frame]:
    """The kind and the picture of this number, 480 × 640; kinds take turns."""
    kind = list(KINDS)[number % len(KINDS)]
    random = Random(f"foreign/{number}")
    return kind, _placed(KINDS[kind](random), random)


def _qr(code: "segno.QRCode | Frame") -> Frame:
    modules = code if isinstance(code, np.ndarray) else np.array([list(row) for row in code.matrix], np.uint8)
    return np.asarray(np.kron(np.where(np.pad(modules, 4) > 0, 30, 220), np.ones((5, 5))), np.uint8)


def _placed(code: Frame, random: Random) -> Frame:
    """On a wall, a little turned, as large as fits; sometimes with grain."""
    frame = np.full((HEIGHT, WIDTH), random.randint(60, 180), np.uint8)
    height, width = code.shape
    scale = min(1.2, 420 / height, 560 / width) * random.uniform(0.7, 1.0)
    turn = cv2.getRotationMatrix2D(
        (width / 2, height / 2), random.choice((0, 0, 90, 180, random.uniform(0, 360))), scale
    )
    turn[:, 2] += (WIDTH - width) / 2 + random.uniform(-30, 30), (HEIGHT - height) / 2 + random.uniform(-20, 20)
    cv2.warpAffine(code, turn, (WIDTH, HEIGHT), frame, cv2.INTER_LINEAR, cv2.BORDER_TRANSPARENT)
    if random.random() < 0.3:
        grain = np.random.default_rng(random.getrandbits(64)).normal(0, 12, frame.shape)
        frame = np.clip(frame + grain, 0, 255).astype(np.uint8)
    return frame
