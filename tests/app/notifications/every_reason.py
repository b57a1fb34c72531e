"""Every reason that the code of robots and of the service can give, collected from that code: a new one is found here
before anybody has to read it raw."""

import ast
import re
from collections.abc import Iterator, Set
from functools import cache
from itertools import cycle
from pathlib import Path

from app.core.settings import ROOT
from app.dispatch import held_up, why_orders_wait
from app.models import OrderState
from app.orders.timer import NOT_FETCHED_IN_TIME
from app.orders.views import reasons
from app.robots.progress.answers import RECALLED
from app.robots.progress.evidence import UNPROVED
from app.robots.progress.handed_over import NOT_PROVED
from app.robots.progress.missions import NOT_REPORTED, UNLOADED
from app.robots.progress.receipts import PROBLEMS, claimed
from protocol.parts import Purpose
from robot.agent.actions.actions import UNKNOWN
from robot.agent.actions.corridors import CLOSED_BY
from robot.reflexes import FAULTS
from robot.skills.ends import ENDS, OF_ANY

ROBOT = ROOT / "robot"
FAILING = {"Ended", "Failed", "WrongArguments"}
"""Calls whose first argument is the atom that says why something failed."""
RAW = re.compile(r"\b[a-z]+(?:_[a-z0-9]+)+\b|\{\w+\}|\b(?:why|gap|alarm)\.[a-z_.]+")
"""Text that no reader should see: an atom of several words, a gap, a key."""


@cache
def codes_of_robots() -> Set[str]:
    """Why an action failed or a stop was given up."""
    skills = {code for ends in ENDS for code in (*ends.reasons, ends.on_timeout)}
    return {*skills, *OF_ANY, *(fault.name for fault in FAULTS), *CLOSED_BY, UNKNOWN, *_failures(), *_hopeless()}


def _failures() -> Iterator[str]:
    for file in sorted(ROBOT.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Call) and getattr(node.func, "id", None) in FAILING and node.args:
                yield from _atoms(node.args[0])
            if isinstance(node, ast.FunctionDef) and node.name == "_why_no_way":
                yield from (
                    one for part in ast.walk(node) if isinstance(part, ast.Return) for one in _atoms(part.value)
                )


def _atoms(node: ast.AST | None) -> Iterator[str]:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value


def _hopeless() -> Iterator[str]:
    for file in sorted(ROBOT.rglob("*.asl")):
        yield from re.findall(r"^(?:hopeless|closes_the_way)\((\w+)\)", file.read_text(), re.MULTILINE)


def sentences_with_codes() -> Iterator[str]:
    """Sentences in which a code stands, with every code that may stand there."""
    for code in sorted(codes_of_robots()):
        yield f"The robot met a problem: {code}."
        yield f"The robot cannot get to the sender: {code}."
        yield f"Nobody took the mail back ({code}). It is still in robot r1."
    for state, purpose in zip(OrderState, cycle(Purpose), strict=False):
        yield f"Order 01ARZ is {state}. But its mail changed hands ({purpose}) at post1."
    for problem, purpose in zip(PROBLEMS.values(), cycle(Purpose), strict=False):
        yield f"a receipt ({purpose}) for order 01ARZ counts for nothing: {problem}"
    for problem, purpose in zip(UNPROVED, cycle(Purpose), strict=False):
        yield claimed(purpose, "01ARZ", "post1", problem)


@cache
def what_the_agent_tells() -> Set[str]:
    """The sentences that our own program raises faults with."""
    told = {
        text for file in ROBOT.rglob("*.asl") for text in re.findall(r'raise_fault\(\w+, "([^"]+)"\)', file.read_text())
    }
    return {f"The robot met a problem: {text}." for text in told}


def refusals_of_robots() -> Iterator[str]:
    """Yield the sentences with which a robot refuses a command."""
    for path, names in REFUSING.items():
        for node in ast.walk(ast.parse((ROOT / path).read_text())):
            if isinstance(node, ast.FunctionDef) and node.name in names:
                yield from (
                    text for part in ast.walk(node) if isinstance(part, ast.Return) and (text := said(part.value))
                )


REFUSING = {
    "robot/mission/mission.py": {"_cancel"},
    "robot/mission/custody.py": {"confirm"},
    "robot/localization/closed.py": {"open_way"},
}


def said(node: ast.AST | None) -> str | None:
    """A sentence as it is put together, with its gaps filled."""
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "x1" for part in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def what_the_service_tells() -> Iterator[str]:
    """Of orders, and of messages that it or a robot could not follow."""
    yield from (NOT_PROVED, NOT_FETCHED_IN_TIME, RECALLED, UNLOADED, NOT_REPORTED, "The recipient cannot take it now.")
    yield from told_beside_alarms(ROOT / "app/robots/conversation/intake.py")
    for module in (reasons, held_up, why_orders_wait):
        texts = (value for name, value in vars(module).items() if name.isupper())
        yield from (text.format(orders=3) for text in texts if isinstance(text, str))
    yield from held_up.SENTENCES.values()


def told_beside_alarms(file: Path) -> Iterator[str]:
    """The sentence that stands beside `raise_alarm`, or in a name `sentence` just before."""
    for node in ast.walk(ast.parse(file.read_text())):
        told: ast.AST | None = None
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", None) == "sentence":
            told = node.value
        if isinstance(node, ast.Call) and getattr(node.func, "id", None) == "raise_alarm":
            told = node.args[3]
        if text := said(told):
            yield text


def every_reason() -> list[str]:
    return sorted(
        {
            *codes_of_robots(),
            *sentences_with_codes(),
            *what_the_agent_tells(),
            *refusals_of_robots(),
            *what_the_service_tells(),
            *(fault.told for fault in FAULTS),
        }
    )
