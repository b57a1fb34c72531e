"""Messages of either side: one was handled, or could not be."""

from protocol.parts import Part, Sentence, Seq


class Ack(Part):
    """Carries nothing but the envelope's `ack`, for when there is nothing else to say."""


class Error(Part):
    """A message could not be handled: its stable `code`, a sentence, and the `seq` it had, if it could be read."""

    code: str
    message: Sentence
    seq: Seq | None = None
