"""Messages from the service to a robot: one frozen class per message."""

from typing import Any, Literal

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer

from protocol.parts import (
    Identifier,
    Leg,
    Moment,
    Part,
    PostName,
    Purpose,
    Received,
    Sentence,
    Seq,
    Sha256Hex,
    Stop,
)


class Welcome(Part):
    """The answer to `hello`: what the server last had from this robot's journal; resume from there.

    `resume_from` is the lowest `seq` of the server's own journal that can still come. `at` is the server's time.
    `home` is the bay in which the robot rests: left out where the map has no bays, and for a robot that is older than
    it and has its home from its settings.
    """

    received: Received
    resume_from: Seq = 1
    server: Sentence
    at: Moment
    home: PostName | None = None

    @model_serializer(mode="wrap")
    def _without_nothing(self, whole: SerializerFunctionWrapHandler) -> dict[str, Any]:
        told: dict[str, Any] = whole(self)
        if self.home is None:
            told.pop("home", None)
        return told


class Mission(Part):
    """The stops to serve now. The same update again is a no-op; different stops under the same number are an error."""

    id: Identifier
    update: Seq
    stops: tuple[Stop, ...]


class Verifier(Part):
    """The SHA-256 of one hand-over code: enough to check it offline, useless to a thief."""

    order_id: Identifier
    purpose: Purpose
    sha256: Sha256Hex
    expires_at: Moment


class Verifiers(Part):
    """Verifiers: they check the hand-over codes of some orders without network.

    Replaces all codes of every order that it names: a code that is not among them opens nothing any more. An order may
    have several codes for one purpose, one for each person who may hand over.
    """

    verifiers: tuple[Verifier, ...]


class Grant(Part):
    """Corridors that may be entered, in order; each holds until the robot reports it clear, or a person revokes it."""

    claim_id: Identifier
    legs: tuple[Leg, ...] = Field(min_length=1)


class Deny(Part):
    """The claim is refused; these corridors are to be avoided for now."""

    claim_id: Identifier
    avoid: tuple[Leg, ...]
    reason: Sentence


class Detour(Part):
    """Go this way first, so that others can pass, and then on by its own plan. These corridors are granted with it.

    It answers a claim of other corridors. A robot that has gone on from where it begins takes it for a plain grant.
    """

    claim_id: Identifier
    legs: tuple[Leg, ...] = Field(min_length=1)
    reason: Sentence


class Cancel(Part):
    """Drop what concerns this order. With the mail aboard the robot refuses and says so.

    `by_hand`: a person has taken the mail out, it is not aboard any more whatever the robot believes.
    """

    command_id: Identifier
    order_id: Identifier
    by_hand: bool = False


class Confirm(Part):
    """Hand over now: a person said so in the app, by a tap or by the six digits of a code, and the server has checked.

    The robot does so if it waits at a stop for this order and purpose (`stop_id`: at this one), and its receipt names
    `command_id` and repeats `by`: the SHA-256 of the code that this person could have shown instead. Else it refuses,
    and so it does after `expires_at` by its own clock: who wanted it may have gone.
    """

    command_id: Identifier
    order_id: Identifier
    stop_id: Identifier | None = None
    purpose: Purpose
    how: Literal["tap", "digits"]
    by: Sha256Hex | None = None
    expires_at: Moment


class Pause(Part):
    """Stand still at the next post until told to resume."""

    command_id: Identifier
    reason: Sentence


class Resume(Part):
    """Go on after a pause, and after an emergency stop: the dispatcher who sends it has looked."""

    command_id: Identifier


class EmergencyStop(Part):
    """Stand still at once, wherever the robot is, and stay so, through a restart as well, until a `resume`, or until
    a person lets it go at the robot itself.

    A best effort: it takes effect when it arrives. The answer says that it has; a robot without network has not heard.
    """

    command_id: Identifier
    reason: Sentence


class Recall(Part):
    """Bring what is aboard back, to the mailroom if the robot has one set, else to where it came from; then go home.

    Accepted with mail aboard, too: the robot then gives itself a mission whose stops are of the kind `return`, and
    whose id begins with `return-`; another mission takes its place.
    """

    command_id: Identifier
    reason: Sentence


class OpenWay(Part):
    """A corridor in which the robot turned back is free again: the dispatcher who sends it has looked.

    `ends` are its two posts, in either order; it is open in both directions. A robot that has turned back in there
    after `looked_at` by its own clock knows better and refuses; so it does if its map has no such corridor. Where it
    was not closed there is nothing to do, which is accepted.
    """

    command_id: Identifier
    ends: tuple[PostName, PostName]
    looked_at: Moment


class Revoke(Part):
    """Everything that was granted until now is void: a person has looked where the robot was, and others may go there.

    The robot stands still at once, as after an `emergency_stop`, and forgets where it is. When a person has let it go
    again it stands on until it sees a marker or is in a dock; then it says where it is, and claims anew.
    """

    command_id: Identifier
    reason: Sentence


class Watch(Part):
    """Send what you sense and think in `insight` messages, for so many seconds of the machine's time.

    Sent again as long as a technician watches. `whole`: a new one does, so the next report has all beliefs. A best
    effort like the reports themselves: not kept, and nothing else depends on it.
    """

    for_s: float = Field(ge=0.0, le=120.0)
    whole: bool = False
