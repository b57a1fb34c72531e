"""What an agent tells while somebody listens: one entry for every choice, in the order in which they are made."""

from typing import NamedTuple, TypeAlias


class Deliberated(NamedTuple):
    """An event was selected, and for it a plan (None: no plan applied) out of so many relevant ones."""

    cycle: int
    event: str
    plan: str | None
    relevant: int

    def __str__(self) -> str:
        if self.plan:
            return f"{self.cycle} {self.event}: plan {self.plan}, of {self.relevant} relevant"
        return f"{self.cycle} {self.event}: none of {self.relevant} relevant plans applies"


class Stepped(NamedTuple):
    """An intention took a step."""

    cycle: int
    intention: int
    step: str

    def __str__(self) -> str:
        return f"{self.cycle} intention {self.intention}: {self.step}"


class Failed(NamedTuple):
    """A goal was given up."""

    cycle: int
    goal: str
    error: str
    message: str

    def __str__(self) -> str:
        return f"{self.cycle} {self.goal} given up: {self.error}, {self.message}"


TraceEntry: TypeAlias = Deliberated | Stepped | Failed
