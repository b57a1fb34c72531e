"""The nouns that several messages share. Times are UTC, lengths are metres, charge is a ratio of 0 to 1."""

from datetime import UTC, datetime
from enum import StrEnum
from typing import Annotated, Any, Final

from pydantic import (
    AfterValidator,
    AwareDatetime,
    BaseModel,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    StringConstraints,
    model_serializer,
)

from protocol.one_line import one_line

PostName = Annotated[str, StringConstraints(pattern=r"^[a-z][A-Za-z0-9_]*$", max_length=64)]
"""A post as the map spells it: also an AgentSpeak atom, so that it can stand in a belief."""

Identifier = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]
LONGEST_SENTENCE: Final = 500
Sentence = Annotated[
    str, StringConstraints(max_length=LONGEST_SENTENCE, pattern=r"^[^\x00]*$"), AfterValidator(one_line)
]
"""What people read, on one line. PostgreSQL stores no zero byte: a message with one would fail again and again."""

Ratio = Annotated[float, Field(ge=0.0, le=1.0)]
Seq = Annotated[int, Field(ge=1, le=2**53)]
"""A number in a journal; what every database and every JSON reader can hold."""

Moment = Annotated[AwareDatetime, Field(ge=datetime(1970, 1, 1, tzinfo=UTC), lt=datetime(3000, 1, 1, tzinfo=UTC))]
"""When something happened, with its zone. A device that has lost its clock says 1970: allowed, and an alarm."""

Sha256Hex = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
Signature = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9+/]{86}==$")]
"""64 bytes of Ed25519 as base64."""


def sentence(text: object) -> str:
    """Any text as what a message may carry: cut, and on one line."""
    return one_line(str(text))[:LONGEST_SENTENCE]


class Part(BaseModel):
    """Frozen and exact: an undeclared field is an error, never ignored; numbers are finite."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class StopAction(StrEnum):
    """Actions at a stop. `return`: undelivered mail is given to its sender again, or to the mailroom."""

    LOAD = "load"
    RECEIVE = "receive"
    RETURN = "return"
    DOCK = "dock"
    PARK = "park"


class Purpose(StrEnum):
    """Purposes of a hand-over code: putting mail in, taking it out, or taking back what was not delivered."""

    LOAD = "load"
    RECEIVE = "receive"
    RETURN = "return"


class Stop(Part):
    """A post and what is done there. `order_id` is given for load, receive and return.

    With `until_ratio` the robot stays in the dock until it has so much charge, or gets no fuller; without, it docks and
    goes on. Left out where there is none: a robot that is older than it would not be able to read the mission.
    """

    id: Identifier
    post: PostName
    action: StopAction
    order_id: Identifier | None = None
    wait_limit_s: float = Field(default=600.0, gt=0)
    until_ratio: Ratio | None = None

    @model_serializer(mode="wrap")
    def _without_nothing(self, whole: SerializerFunctionWrapHandler) -> dict[str, Any]:
        told: dict[str, Any] = whole(self)
        if self.until_ratio is None:
            told.pop("until_ratio", None)
        return told


class Leg(Part):
    """One corridor in one direction."""

    from_post: PostName
    to_post: PostName


class MissionHeld(Part):
    """Which mission the robot holds, and which of its stops comes next (0 = the first)."""

    id: Identifier
    update: Seq
    next_stop: int = Field(ge=0, le=2**53)


class Position(Part):
    """Robots are *seen* at posts: the last one, the one before, and when; `towards` is the post ahead, if known."""

    post: PostName | None = None
    previous: PostName | None = None
    towards: PostName | None = None
    seen_at: Moment | None = None


class Battery(Part):
    """Charge as a ratio of capacity, whether the dock is charging it now, and whether it stands in one at all."""

    ratio: Ratio
    charging: bool = False
    docked: bool | None = None


class Received(Part):
    """The highest contiguous `seq` of the other side's journal that has been handled; nothing yet is journal None."""

    journal: Identifier | None = None
    seq: int = Field(default=0, ge=0, le=2**53)


class Activity(StrEnum):
    """The robot's activity, in one word."""

    IDLE = "idle"
    DRIVING = "driving"
    WAITING = "waiting"
    CHARGING = "charging"
    STOPPED = "stopped"
