"""The proof that a robot puts into its receipt: only a code that was shown gives it.

The robot knows codes by their SHA-256 alone, so that it can check one and cannot make one up. What it reads in a code
gives a key, the key gives the proof of this one hand-over, and then both are forgotten. The service derives the same
from its own key and compares. Six digits never come here: they are too few, and would be found by trying them all.
"""

import hmac
from collections.abc import Iterable
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Final

LABEL: Final = b"campus-mail hand-over proof 1"


@dataclass(frozen=True, slots=True)
class ShownCode:
    """A code that was held up: what it is known by, and the key of its proofs, which must not be kept or logged."""

    sha256: str
    key: bytes = field(repr=False)

    @classmethod
    def of(cls, text: str) -> "ShownCode":
        """From the whole text of the QR form."""
        read = text.encode("ascii", "replace")
        # Not the text itself: as a key, HMAC takes one that is long by its SHA-256, which the robot is told.
        return cls(sha256(read).hexdigest(), hmac.digest(LABEL, read, "sha256"))


def proof_of(key: bytes, values: Iterable[str]) -> str:
    """Return the proof by the holder of `key` over these values, in hex."""
    return hmac.digest(key, b"".join(_framed(value) for value in values), "sha256").hex()


def _framed(value: str) -> bytes:
    """With its length before it, so that no other values give the same bytes."""
    told = value.encode()
    return len(told).to_bytes(4, "big") + told
