"""The envelope of every message, and how text becomes one.

`seq` numbers the durable messages of a journal without gaps and never goes back. A robot's journal is born with its
outbox database, the service's with the robot's enrolment; a new one begins if that was put back from an older copy.

`ack` is the highest contiguous `seq` that the sender has handled from the other side. `replay`
marks what is sent from the backlog after a reconnect.
"""

from collections.abc import Mapping
from typing import Any, Final

from pydantic import Field, SerializeAsAny, ValidationError
from pydantic_core import from_json

from protocol import both_ways, diagnostics, to_robot, to_server
from protocol.errors import MalformedMessage, MessageTooLarge, NewerVersion, ProtocolError, UnknownMessage
from protocol.parts import Identifier, Moment, Part, Seq

MAJOR_VERSION: Final = 1
MINOR_VERSION: Final = 1
"""Goes up with what robots may say besides: 1 has proofs in receipts. Told nowhere on the wire (see `YOUNGER`)."""
MAX_MESSAGE_BYTES: Final = 64 * 1024

BOTH_WAYS: Final[Mapping[str, type[Part]]] = {"ack": both_ways.Ack, "error": both_ways.Error}
TO_SERVER: Final[Mapping[str, type[Part]]] = {
    "hello": to_server.Hello,
    "snapshot": to_server.Snapshot,
    "event": to_server.Event,
    "claim": to_server.Claim,
    "withdraw": to_server.Withdraw,
    "clear": to_server.Clear,
    "occupancy": to_server.Occupancy,
    "why": to_server.Why,
    "insight": diagnostics.Diagnostics,
    **BOTH_WAYS,
}
TO_ROBOT: Final[Mapping[str, type[Part]]] = {
    "welcome": to_robot.Welcome,
    "mission": to_robot.Mission,
    "verifiers": to_robot.Verifiers,
    "grant": to_robot.Grant,
    "deny": to_robot.Deny,
    "detour": to_robot.Detour,
    "cancel": to_robot.Cancel,
    "confirm": to_robot.Confirm,
    "pause": to_robot.Pause,
    "resume": to_robot.Resume,
    "recall": to_robot.Recall,
    "emergency_stop": to_robot.EmergencyStop,
    "open_way": to_robot.OpenWay,
    "revoke": to_robot.Revoke,
    "watch": to_robot.Watch,
    **BOTH_WAYS,
}
YOUNGER: Final = ("confirm", "watch", "open_way", "detour", "revoke", "until_ratio", "proof", "home")
"""What came later: types to robots and some fields, sent only to those that name them in `hello`, since an older robot
would hang up; and what a robot proves, which is expected of those that name it."""

DURABLE: Final = frozenset({"event", "claim", "withdraw", "clear", "occupancy"}) | {
    *("mission", "verifiers", "grant", "deny", "detour"),
    *("cancel", "confirm", "pause", "resume", "recall", "emergency_stop", "open_way", "revoke"),
}
"""The types that are stored before they are sent, numbered, and sent again until they are acknowledged."""

_TYPE_OF: Final = {message: name for name, message in {**TO_SERVER, **TO_ROBOT}.items()}


class Head(Part):
    """The head of a message: everything around its body."""

    v: int = MAJOR_VERSION
    type: str
    robot: Identifier
    journal: Identifier
    seq: Seq | None = None
    ack: int = Field(default=0, ge=0, le=2**53)
    at: Moment
    replay: bool = False

    def around(self, body: str) -> str:
        """The JSON text that is sent, for a body that is JSON already."""
        return f'{self.model_dump_json()[:-1]},"body":{body}}}'


class Envelope(Head):
    """One message on the wire; `body` is one of the classes in `TO_SERVER` or `TO_ROBOT`."""

    body: SerializeAsAny[Part]

    def to_text(self) -> str:
        """The JSON text that is sent."""
        return self.model_dump_json()


def type_of(message: Part) -> str:
    """The wire name of a message: `type_of(Hello(...)) == "hello"`."""
    return _TYPE_OF[type(message)]


def parse(text: str | bytes, accepted: Mapping[str, type[Part]]) -> Envelope:
    """Read one message; `accepted` is `TO_SERVER` on the server and `TO_ROBOT` on the robot.

    Raises MessageTooLarge, MalformedMessage, NewerVersion or UnknownMessage; no input raises anything else.
    """
    raw = _read_object(text)
    try:
        return _read_envelope(raw, accepted)
    except ProtocolError as error:
        seq = raw.get("seq")
        is_legible = isinstance(seq, int) and not isinstance(seq, bool) and 1 <= seq <= 2**53
        error.seq = seq if is_legible else None
        raise


def _read_envelope(raw: dict[str, Any], accepted: Mapping[str, type[Part]]) -> Envelope:
    _check_version(raw.get("v"))
    name = raw.get("type")
    if not isinstance(name, str) or name not in accepted:
        raise UnknownMessage(f"message type {name!r} is not known here; known are {', '.join(sorted(accepted))}")
    try:
        body = accepted[name].model_validate(raw.get("body"))
        envelope = Envelope.model_validate({**raw, "body": body})
    except ValidationError as error:
        raise MalformedMessage(f"{name}: {_first_problem(error)}") from None
    if (envelope.seq is not None) != (name in DURABLE):
        raise MalformedMessage(f"{name}: seq: durable messages carry a seq, others none")
    return envelope


def _read_object(text: str | bytes) -> dict[str, Any]:
    data = text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass")
    if len(data) > MAX_MESSAGE_BYTES:
        raise MessageTooLarge(f"message of {len(data)} bytes; at most {MAX_MESSAGE_BYTES} are taken")
    try:
        raw = from_json(data)
    except ValueError as error:
        raise MalformedMessage(f"not JSON: {error}") from None
    if not isinstance(raw, dict):
        raise MalformedMessage(f"an envelope is a JSON object, this is a {type(raw).__name__}")
    return raw


def _check_version(version: object) -> None:
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise MalformedMessage(f"v: a whole number from 1, not {version!r}")
    if version > MAJOR_VERSION:
        raise NewerVersion(f"version {version} is newer than {MAJOR_VERSION}: update this side first")


def _first_problem(error: ValidationError) -> str:
    first = error.errors()[0]
    place = ".".join(str(part) for part in first["loc"]) or "body"
    return f"{place}: {first['msg']}"
