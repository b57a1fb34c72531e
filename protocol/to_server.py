"""Messages from a robot to the service: one frozen class per message."""

from datetime import UTC
from enum import StrEnum
from typing import Annotated, Any, Literal

from pydantic import Field

from protocol.parts import (
    Activity,
    Battery,
    Identifier,
    Leg,
    MissionHeld,
    Moment,
    Part,
    Position,
    PostName,
    Purpose,
    Received,
    Sentence,
    Seq,
    Sha256Hex,
    Signature,
)
from protocol.proofs import proof_of


class Hello(Part):
    """The first message on every connection: where to resume from, and what the robot knows of itself.

    `received` is what it last had from the server, `resume_from` the lowest `seq` of its own journal that can still
    come. `understands` names what is younger than the protocol and known to this robot (messages, the field
    `until_ratio` of stops, `home` of `welcome`, and `proof`: its receipts prove that a code was shown); it is sent
    nothing else of that kind. `home` is the post of its own dock, or the bay in which it rests.
    """

    received: Received = Received()
    resume_from: Seq = 1
    position: Position
    cargo: tuple[Identifier, ...] = ()
    mission: MissionHeld | None = None
    battery: Battery
    software: Sentence
    map_version: Sentence
    understands: tuple[Identifier, ...] = ()
    home: PostName | None = None


class Snapshot(Part):
    """The state now: at most once a second and on change; dropped while offline, since a newer one replaces it."""

    position: Position
    activity: Activity
    battery: Battery
    cargo: tuple[Identifier, ...] = ()
    mission: MissionHeld | None = None


class Step(StrEnum):
    """Steps of a mission."""

    ACCEPTED = "accepted"
    DEPARTED = "departed"
    PASSED = "passed"
    ARRIVED = "arrived"
    GAVE_UP = "gave_up"
    DONE = "done"


class Progress(Part):
    """A step of a mission. `stop_id` is the stop it concerns, `post` the place where it happened.

    `update` is the number of the mission as the robot held it then. Each update is accepted once.
    """

    kind: Literal["progress"] = "progress"
    step: Step
    happened_at: Moment
    mission_id: Identifier
    update: Seq | None = None
    stop_id: Identifier | None = None
    order_id: Identifier | None = None
    post: PostName | None = None
    reason: Sentence | None = None


How = Literal["code", "tap", "digits", "button"]
"""How a hand-over was confirmed: a code shown to the camera, in the app by tap or digits, or the Spot button."""


def _how_before_it_was_told(known: dict[str, Any]) -> How:
    return "code" if known.get("code_sha256") else "button"


class HandoverReceipt(Part):
    """Mail changed hands. Only the robot writes custody.

    `code_sha256` is the verifier that matched (or the `by` of the `confirm`), None if no person was identified (the
    Spot button). `proof` is what only the shown code gives, over this one hand-over: None if none was shown. `number`
    counts
    its receipts, `mission_id` is the mission as it held it: None from a robot that is older than proofs. `command_id`
    names the `confirm`, if one led to it. `signature` is Ed25519 over `signed_by(robot)`, base64; None from a robot
    that was enrolled without a key.
    """

    kind: Literal["handover"] = "handover"
    purpose: Purpose
    order_id: Identifier
    stop_id: Identifier
    post: PostName
    happened_at: Moment
    code_sha256: Sha256Hex | None
    how: How = Field(default_factory=_how_before_it_was_told)
    command_id: Identifier | None = None
    mission_id: Identifier | None = None
    number: Seq | None = None
    proof: Sha256Hex | None = None
    signature: Signature | None = None

    def signed_by(self, robot: str) -> bytes:
        """Return the bytes that this robot's signature is over: one value a line, `-` for none, no line end after the
        last."""
        values = (robot, self.purpose, self.order_id, self.stop_id, self.post, self._moment)
        how = (self.code_sha256 or "-", self.how, self.command_id or "-")
        if self.number is None:
            return "\n".join(("campus-mail receipt 1", *values, *how)).encode("ascii")
        later = (self.mission_id or "-", str(self.number), self.proof or "-")
        return "\n".join(("campus-mail receipt 2", *values, *how, *later)).encode("ascii")

    def proved_with(self, key: bytes) -> str:
        """The proof of this hand-over, made by a holder who has read the code with this key."""
        place = (self.order_id, self.mission_id or "-", self.stop_id, self.purpose, self.post)
        return proof_of(key, (*place, str(self.number or "-"), self._moment))

    @property
    def _moment(self) -> str:
        return self.happened_at.astimezone(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")


class Charge(Part):
    """The battery plan took over or let go again."""

    kind: Literal["charge"] = "charge"
    step: Literal["low", "charging", "charged"]
    happened_at: Moment
    post: PostName | None = None
    ratio: float = Field(ge=0.0, le=1.0)


class Fault(Part):
    """Something a person should know of; `cleared` tells that it is over."""

    kind: Literal["fault"] = "fault"
    name: Identifier
    cleared: bool = False
    happened_at: Moment
    post: PostName | None = None
    reason: Sentence


class CommandAnswer(Part):
    """The result of a command (`cancel`, `pause`, `open_way` …): `command_id` is the one it carried."""

    kind: Literal["answer"] = "answer"
    command_id: Identifier
    accepted: bool
    happened_at: Moment
    reason: Sentence | None = None


class Event(Part):
    """Durable: kept on the robot's disk until the server has committed it."""

    happened: Annotated[Progress | HandoverReceipt | Charge | Fault | CommandAnswer, Field(discriminator="kind")]


class Claim(Part):
    """I would like to enter these corridors in this order, and take a bay at the far end of the last one.

    `goal` is the post that I am going to now; the corridors behind it are for what comes after that.
    """

    claim_id: Identifier
    legs: tuple[Leg, ...] = Field(min_length=1)
    goal: PostName | None = None


class Withdraw(Part):
    """I no longer want what I asked for. A grant that I am told of all the same is given back by `clear`."""

    claim_id: Identifier


class Clear(Part):
    """I am clear of this corridor: no time-out frees it, only this, or a person who looked (`revoke`).

    `post` is where I was seen last: the corridor's far end when I have driven through it, its near end when I give it
    back.
    """

    leg: Leg
    post: PostName | None = None


Where = Literal["bay", "crossing", "corridor"]
Evidence = Literal["marker", "distance", "dock", "map"]


class Occupancy(Part):
    """I am wholly in this bay or corridor, or on this crossing, and out of what I was in before.

    `post` is the bay, the post whose lines cross, or the end of the corridor that lies behind; then `towards` is the
    other end. `evidence`: a marker that was read, the distance driven since the last one (`way_mm`), the contacts of a
    dock, or the map alone where a marker cannot be read. Sent on maps with bays, for each place once.
    """

    where: Where
    post: PostName
    towards: PostName | None = None
    evidence: Evidence
    way_mm: int | None = Field(default=None, ge=0, le=10**7)
    happened_at: Moment


class Why(Part):
    """The robot's present activity and what it waits for, in words, from its agent's intentions."""

    sentence: Sentence
    goal: Sentence | None = None
    waiting_for: Sentence | None = None
