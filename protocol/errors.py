"""Errors of a message.

ProtocolError
├── MalformedMessage   not JSON, not an envelope, or a body that does not fit its type
├── UnknownMessage     a type that this side does not know
├── NewerVersion       written for a later major version of the protocol
└── MessageTooLarge    more bytes than a message may have
"""


class ProtocolError(ValueError):
    """A message that cannot be handled. `code` and `seq`, if it was legible, travel in the `error` that answers it."""

    code = "protocol_error"

    def __init__(self, sentence: str, seq: int | None = None) -> None:
        # What the sentence quotes came from outside; half a surrogate pair could not be sent back.
        super().__init__(sentence.encode("utf-8", "backslashreplace").decode())
        self.seq = seq


class MalformedMessage(ProtocolError):
    """The text is no envelope or its body does not fit; the sentence names the field."""

    code = "malformed_message"


class UnknownMessage(ProtocolError):
    """The envelope is sound, its `type` is not one that this side accepts."""

    code = "unknown_message"


class NewerVersion(ProtocolError):
    """The sender speaks a later major version: this side has to be updated first."""

    code = "newer_version"


class MessageTooLarge(ProtocolError):
    """The text is longer than `MAX_MESSAGE_BYTES`."""

    code = "message_too_large"
