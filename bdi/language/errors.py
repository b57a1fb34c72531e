"""Errors, by name.

BdiError
├── AgentSpeakError            the program is at fault: carries file, line and column
│   ├── AgentSpeakSyntaxError  the text is not AgentSpeak
│   ├── IncludeNotFound        an included file is missing or cannot be read
│   ├── IncludeCircle          a file includes itself, directly or through others
│   ├── UnknownDirective       `{ something }` that is no directive of ours
│   ├── UnknownInternalAction  `.something` that does not exist
│   ├── UnknownAction          an action that the body did not declare
│   └── WrongPriority          a table of priorities that is none, or a level that it does not have
├── StepFailed                 a step of a plan cannot be done (in `intentions`; plans see it as -!g[error(E)])
├── ArithmeticFailure          numbers that cannot be calculated (in `arithmetic`)
├── UnknownActionId            a finished action that was never started
├── UnknownPerformative        a message that is no tell, achieve, …
├── UnknownAgent               an agent that a system does not have
├── DuplicateAgent             a second agent of one name in a system
├── NotARecording              a file that is no recorded run, or was changed (in `replaying`)
├── NotReplayable              a run that took more than a recording holds (in `replaying`)
├── RecordedTooLate            an agent is to be recorded that has already run (in `recording`)
├── OtherSensor                a reading of one sensor that holds a percept of another
└── NotALiteral                a percept, belief or goal given as another kind of term, such as a number
"""

from collections.abc import Sequence
from dataclasses import dataclass


class BdiError(Exception):
    """Root of everything that `bdi` raises on purpose."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a program. Line and column count from 1; 0 means "not known"."""

    source: str = "<text>"
    line: int = 0
    column: int = 0
    text: str = ""

    def __str__(self) -> str:
        return f"{self.source}:{self.line}:{self.column}" if self.line else self.source

    def picture(self) -> str:
        """The line with a caret under the column, or nothing where the line is not known."""
        if not self.text.strip():
            return ""
        shown = self.text.replace("\t", " ")
        return f"\n    {shown}\n    {' ' * max(0, self.column - 1)}^"


class AgentSpeakError(BdiError):
    """A program that cannot be loaded. `str()` is the whole message: place, sentence, line and caret."""

    def __init__(self, problem: str, place: Place, expected: tuple[str, ...] = ()) -> None:
        self.problem = problem
        self.place = place
        self.expected = expected
        hint = f"; expected {_either(expected)}" if expected else ""
        super().__init__(f"{place}: {problem}{hint}{place.picture()}")

    @property
    def source(self) -> str:
        return self.place.source

    @property
    def line(self) -> int:
        return self.place.line

    @property
    def column(self) -> int:
        return self.place.column


class AgentSpeakSyntaxError(AgentSpeakError):
    """The text is not AgentSpeak; `expected` lists what could have stood there."""


class IncludeNotFound(AgentSpeakError):
    """`{ include("file") }` names a file that cannot be read."""


class IncludeCircle(AgentSpeakError):
    """A file includes itself, directly or through others."""


class UnknownDirective(AgentSpeakError):
    """A directive that this interpreter does not have."""


class UnknownInternalAction(AgentSpeakError):
    """A plan or rule calls `.something` that does not exist, or with a wrong number of arguments."""


class UnknownAction(AgentSpeakError):
    """A plan starts an action that the body did not declare in `actions=`."""


class WrongPriority(AgentSpeakError):
    """The table of priorities is none, or a plan or event names a level that it does not have."""


class UnknownActionId(BdiError):
    """`finished` names an action that this agent never started: the caller mixed up two agents or two runs."""


class UnknownPerformative(BdiError):
    """A message whose performative this agent does not understand."""

    def __init__(self, performative: str) -> None:
        super().__init__(
            f"no agent understands the performative {performative!r}; there are tell, untell, achieve, unachieve, "
            "askOne, askAll, askHow, tellHow, untellHow and signal, and those for which the receiver has plans "
            "+!kqml_received"
        )


class UnknownAgent(BdiError):
    """Stimuli for an agent that the system does not have: it was never there, or was killed."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        super().__init__(f"there is no agent {name!r}; there are {', '.join(known) or 'none'}")


class DuplicateAgent(BdiError):
    """Two agents of one name: `MultiAgentSystem.free_name` gives a name that is not taken."""

    def __init__(self, name: str) -> None:
        super().__init__(f"there is an agent {name!r} already")


class OtherSensor(BdiError):
    """`Perception.replace` was given a percept of another name: it would never be forgotten with its sensor."""

    def __init__(self, name: str, percept: object) -> None:
        super().__init__(f"{percept} is no percept of the sensor {name!r}")


class NotALiteral(BdiError):
    """A percept, belief or goal given as something else, such as a number or a list."""

    def __init__(self, given: object, problem: Exception | None = None) -> None:
        why = "give a term such as Atom or Structure, or its text"
        if isinstance(problem, BdiError):
            why = str(problem)
        super().__init__(f"{given!r} is no literal: {why}")


def _either(options: tuple[str, ...]) -> str:
    return options[0] if len(options) == 1 else ", ".join(options[:-1]) + " or " + options[-1]
