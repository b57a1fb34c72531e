"""Errors between a program and Campus Mail.

CampusMailError
├── NoAnswer          nothing came back, also after all tries; whether a change was made is not known
├── UnexpectedAnswer  an answer that no version of this client understands
└── Problem           the service said no (RFC 9457); `problems.py` has one class for each `code`
"""

from dataclasses import dataclass


class CampusMailError(Exception):
    """Whatever this client raises."""


class NoAnswer(CampusMailError):
    """No network, no service, or too slow."""


class UnexpectedAnswer(CampusMailError):
    """Not an answer of Campus Mail: another program, or a proxy, has spoken."""


@dataclass(frozen=True)
class WrongField:
    """A field of the request that does not fit."""

    field: str
    message: str


class Problem(CampusMailError):
    """The service refused: `code` is stable, the sentence is for people."""

    code = ""

    def __init__(
        self,
        sentence: str,
        status: int,
        code: str,
        errors: tuple[WrongField, ...] = (),
        retry_after_s: float | None = None,
    ) -> None:
        super().__init__(sentence)
        self.sentence, self.status, self.code = sentence, status, code
        self.errors, self.retry_after_s = errors, retry_after_s
