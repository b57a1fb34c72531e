"""Nothing lost and nothing taken twice: what a receiver makes of journals and numbers. The same on both sides.

A sender numbers its durable messages 1, 2, 3 … in a journal and sends them in that order, again and again until they
are acknowledged. `hello` and `welcome` name the lowest number that can still come (`resume_from`), so that a receiver
that has never seen the journal, or that has forgotten part of it, knows where to begin instead of waiting for ever.
"""

from dataclasses import dataclass
from enum import StrEnum

from protocol.parts import Received


class Reception(StrEnum):
    """The meaning of a durable message to its receiver."""

    NEW = "new"
    """The next one: handle it, then acknowledge it."""

    REPEATED = "repeated"
    """Handled before: acknowledge it again and do nothing else."""

    GAP = "gap"
    """One before it is missing, or the journal is unknown: do not handle it, ask the sender to resume."""


def reception(received: Received, journal: str, seq: int) -> Reception:
    """Judge the message `seq` of `journal` by what has been received so far."""
    if received.journal != journal or seq > received.seq + 1:
        return Reception.GAP
    return Reception.NEW if seq == received.seq + 1 else Reception.REPEATED


@dataclass(frozen=True)
class Resumption:
    """Where a receiver stands after a greeting. `lost` messages can never come again: someone should know."""

    received: Received
    lost: int = 0


def resume(received: Received, journal: str, resume_from: int) -> Resumption:
    """Take up `journal`, of which nothing before `resume_from` will come any more."""
    before = resume_from - 1
    if received.journal != journal:
        return Resumption(Received(journal=journal, seq=before))
    if received.seq >= before:
        return Resumption(received)
    return Resumption(Received(journal=journal, seq=before), lost=before - received.seq)
