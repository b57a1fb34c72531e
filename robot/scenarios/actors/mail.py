"""Where the mail is really, and what the robots say of it."""

from dataclasses import dataclass, field
from hashlib import sha256
from random import Random

from protocol.parts import Purpose
from robot.scenarios.scenario import OrderRow

WITH_SENDER, WITH_RECIPIENT = "sender", "recipient"


def code(seed: int, order: str, purpose: str) -> str:
    """A hand-over code as the service makes it: the prefix and 128 bits."""
    return f"CM1:{Random(f'{seed}/{order}/{purpose}').getrandbits(128):032x}"


def fingerprint(text: str) -> str:
    """Return the SHA-256 of a code: the robot is given no more of it."""
    return sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Receipt:
    """A robot's word that mail changed hands."""

    at_s: float
    robot: str
    purpose: Purpose
    post: str


@dataclass
class Letter:
    """One order's mail. `place` is the truth: sender, recipient, or the name of the robot whose box it is in."""

    order: OrderRow
    load_code: str
    receive_code: str
    place: str = WITH_SENDER
    moved: list[tuple[float, str]] = field(default_factory=list)
    """When it was put where, by a person."""
    receipts: list[Receipt] = field(default_factory=list)
    gave_up: list[str] = field(default_factory=list)
    """Why a robot has told that it could not do what was wanted with it."""
    robot: str | None = None
    """Who is to carry it."""
    cancelled: bool = False
    recalled: bool = False
    returning: bool = False
    """The sender has been asked to take it back."""

    def put(self, place: str, now: float) -> None:
        self.place = place
        self.moved.append((now, place))

    @property
    def said_to_be_in(self) -> str | None:
        """The robot that says it has it."""
        last = self.receipts[-1] if self.receipts else None
        return last.robot if last and last.purpose is Purpose.LOAD else None


def letters_of(orders: tuple[OrderRow, ...], seed: int) -> dict[str, Letter]:
    """By the order's name."""
    return {one.id: Letter(one, code(seed, one.id, "load"), code(seed, one.id, "receive")) for one in orders}
