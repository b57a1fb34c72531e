"""Mail changes hands: by a code that the camera reads, the Spot button, or because a person confirmed it in the app.

Only the robot writes custody. What a person says in the app is a wish that reaches the robot as a `confirm`; it takes
effect if the robot waits for that person's hand-over just then.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime

from protocol.parts import Purpose, Stop
from protocol.proofs import ShownCode
from protocol.to_robot import Confirm, Mission, Verifier
from protocol.to_server import Event, HandoverReceipt, How
from robot.mission.loading import Loading
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox

Sign = Callable[[HandoverReceipt], HandoverReceipt]
"""Puts the robot's signature under a receipt."""


@dataclass(frozen=True)
class Proof:
    """The basis of a hand-over: the verifier that matched, how it came, and the command that brought it, if one did.

    `key`: of a code that was shown. It proves this one hand-over, and is written down nowhere.
    """

    code_sha256: str | None
    how: How
    command_id: str | None = None
    key: bytes | None = field(default=None, repr=False)

    @classmethod
    def seen(cls, shown: ShownCode | None) -> "Proof":
        """By the camera; nothing seen is the Spot button."""
        return cls(None, "button") if shown is None else cls(shown.sha256, "code", key=shown.key)


@dataclass
class Waiting:
    """The robot stands at a stop and waits for a hand-over there. `place` is the stop as it was when it began."""

    place: tuple[Mission, Stop]
    purpose: Purpose
    post: str
    handed_over: bool = False
    """Mail has changed hands; what is left is the time in which people reach into the box."""


class Custody:
    """Writes down what changed hands. `sign` None: a robot that was enrolled without a key."""

    def __init__(self, memory: Memory, outbox: Outbox, utc: Callable[[], datetime], sign: Sign | None) -> None:
        self._memory, self._outbox, self._utc = memory, outbox, utc
        self._sign = sign or (lambda receipt: receipt)
        self._waiting: Waiting | None = None

    def wait(self, waiting: Waiting) -> None:
        """From now on a `confirm` for this stop takes effect."""
        self._waiting = waiting

    def leave(self, waiting: Waiting) -> None:
        """The wait has ended, however it did."""
        if self._waiting is waiting:
            self._waiting = None

    @property
    def handing_over(self) -> bool:
        """Mail has just changed hands, and the robot stands for those who put it in or take it out."""
        return self._waiting is not None and self._waiting.handed_over

    def confirm(self, wish: Confirm) -> str | None:
        """Hand over as the service says; why not, or None. Call it in the transaction that is done with the message."""
        waiting = self._waiting
        if waiting is None or not _is_meant(wish, waiting):
            return "The robot does not wait for this hand-over."
        if wish.expires_at <= self._utc():
            return "It came too late: the person who asked may have gone."
        if wish.by is not None and wish.by not in self._opening(wish.order_id, waiting.purpose):
            return "That person's code opens nothing here any more."
        waiting.handed_over = True
        self.hand_over(waiting.place, waiting.purpose, waiting.post, Proof(wish.by, wish.how, wish.command_id))
        return None

    def _opening(self, order_id: str, purpose: Purpose) -> tuple[str, ...]:
        return opening(self._memory.verifiers(), self._memory.loadings(), order_id, purpose, self._utc())

    def hand_over(self, place: tuple[Mission, Stop], purpose: Purpose, post: str, proof: Proof) -> bool:
        """Store the cargo, the mission's progress and the receipt, in the caller's transaction; False if it was
        done."""
        mission, stop = place
        order_id = stop.order_id or ""
        if not self._memory.first_time(mission.id, f"handover:{stop.id}"):
            return False
        if purpose is Purpose.LOAD:
            self._memory.load(order_id, Loading(post=post, code_sha256=proof.code_sha256))
        else:
            self._memory.unload(order_id)
        self._memory.pass_stop(stop.id)
        self._outbox.put(Event(happened=self._sign(self._receipt(place, purpose, post, proof))))
        self._memory.forget_verifiers(order_id, purpose if purpose is Purpose.LOAD else None)
        return True

    def _receipt(self, place: tuple[Mission, Stop], purpose: Purpose, post: str, proof: Proof) -> HandoverReceipt:
        mission, stop = place
        receipt = HandoverReceipt(
            purpose=purpose,
            order_id=stop.order_id or "",
            stop_id=stop.id,
            post=post,
            happened_at=self._utc(),
            code_sha256=proof.code_sha256,
            how=proof.how,
            command_id=proof.command_id,
            mission_id=mission.id,
            number=self._outbox.next_receipt(),
        )
        if proof.key is None:
            return receipt
        return receipt.model_copy(update={"proof": receipt.proved_with(proof.key)})


def _is_meant(wish: Confirm, waiting: Waiting) -> bool:
    stop = waiting.place[1]
    is_there = wish.stop_id in (None, stop.id) and wish.order_id == stop.order_id
    return is_there and wish.purpose is waiting.purpose and not waiting.handed_over


def opening(
    verifiers: Iterable[Verifier], loadings: Mapping[str, Loading], order_id: str, purpose: Purpose, now: datetime
) -> tuple[str, ...]:
    """Return the accepted hand-over codes, as SHA-256.

    Mail that is brought back is given to its recipient too, and to a person who shows the code that it was loaded with.
    """
    fit = {purpose, Purpose.RECEIVE} if purpose is Purpose.RETURN else {purpose}
    codes = [
        one.sha256 for one in verifiers if one.order_id == order_id and one.purpose in fit and now < one.expires_at
    ]
    loading = loadings.get(order_id) if purpose is Purpose.RETURN else None
    return (*codes, loading.code_sha256) if loading and loading.code_sha256 else tuple(codes)
