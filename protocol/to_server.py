"""What a robot says to the server: one frozen class per message."""

from enum import StrEnum
from typing import Annotated, Literal

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
)


class Hello(Part):
    """The first message on every connection: where to resume from, and what the robot knows of itself.

    `received` is what it last had from the server, `resume_from` the lowest `seq` of its own journal that can still
    come.
    """

    received: Received = Received()
    resume_from: Seq = 1
    position: Position
    cargo: tuple[Identifier, ...] = ()
    mission: MissionHeld | None = None
    battery: Battery
    software: Sentence
    map_version: Sentence


class Snapshot(Part):
    """The state now: at most once a second and on change; dropped while offline, since a newer one replaces it."""

    position: Position
    activity: Activity
    battery: Battery
    cargo: tuple[Identifier, ...] = ()
    mission: MissionHeld | None = None


class Step(StrEnum):
    """How far a mission has come."""

    ACCEPTED = "accepted"
    DEPARTED = "departed"
    PASSED = "passed"
    ARRIVED = "arrived"
    GAVE_UP = "gave_up"
    DONE = "done"


class Progress(Part):
    """A step of a mission. `stop_id` is the stop it concerns, `post` the place where it happened."""

    kind: Literal["progress"] = "progress"
    step: Step
    happened_at: Moment
    mission_id: Identifier
    stop_id: Identifier | None = None
    order_id: Identifier | None = None
    post: PostName | None = None
    reason: Sentence | None = None


class HandoverReceipt(Part):
    """Mail changed hands. Only the robot writes custody.

    `code_sha256` is the verifier that matched, None if nobody was identified (the Spot button).
    """

    kind: Literal["handover"] = "handover"
    purpose: Purpose
    order_id: Identifier
    stop_id: Identifier
    post: PostName
    happened_at: Moment
    code_sha256: Sha256Hex | None


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
    """What became of a cancel, pause, resume or recall: `command_id` is the one it carried."""

    kind: Literal["answer"] = "answer"
    command_id: Identifier
    accepted: bool
    happened_at: Moment
    reason: Sentence | None = None


class Event(Part):
    """Durable: kept on the robot's disk until the server has committed it."""

    happened: Annotated[Progress | HandoverReceipt | Charge | Fault | CommandAnswer, Field(discriminator="kind")]


class Claim(Part):
    """I would like to enter these corridors in this order, and take a bay at the far end of the last one."""

    claim_id: Identifier
    legs: tuple[Leg, ...] = Field(min_length=1)


class Clear(Part):
    """I am clear of this corridor: the only thing that ever frees it."""

    leg: Leg


class Why(Part):
    """What the robot is doing and waiting for, in words, from its agent's intentions."""

    sentence: Sentence
    goal: Sentence | None = None
    waiting_for: Sentence | None = None
