"""Mangled and made-up AgentSpeak programs: whatever the text, the mind reads and runs it or names what is wrong.

python -m benchmarks.fuzz_mind [--cases 10000] [--seed 1] [--json FILE]
"""

import argparse
import json
import random
import re
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import FrameType

from bdi import Agent, AgentSpeakError, Finished, Message, Program, parse_plan, parse_program

ROOT = Path(__file__).parents[1]
CYCLES = 20
LONGEST_S = 10.0  # of one case; more counts as a hang
LONGEST_TEXT = 4_000
PERCEPTS = ("battery(low)", "line(center)", "p(1)[source(percept)]", "q(a)")


class Hang(Exception):
    """A case that does not end."""


@dataclass
class Report:
    cases: int = 0
    read: int = 0  # how many of them are programs
    run: int = 0  # how many of those an agent was made of
    failures: list[dict[str, str]] = field(default_factory=list)
    slowest_s: float = 0.0
    slowest: str = ""


# ---- what must hold ------------------------------------------------------------------------------------------------


def no_file(path: Path) -> str:
    raise FileNotFoundError(2, "No such file", str(path))


def read(text: str) -> Program | None:
    """The program, or None for what is refused by name at a place inside the text."""
    try:
        return parse_program(text, read=no_file)
    except AgentSpeakError as error:
        lines = text.split("\n")
        assert error.line <= len(lines), error
        assert error.line == 0 or error.column <= len(lines[error.line - 1]) + 1, error
        return None


def reread(program: Program) -> None:
    """Check that the printed plan is read as the same plan. (Local namespaces have no name that a text could say.)"""
    for plan in program.plans:
        written = str(plan)
        if "#" not in written:
            again = str(parse_plan(written))
            assert again == written, f"{written} became {again}"


def run(program: Program) -> bool:
    """Some cycles with a few percepts, messages and failing actions. False: no agent can be made of it."""
    try:
        agent = Agent(program, random_seed=1)
    except AgentSpeakError:
        return False
    finished: list[Finished] = []
    for cycle in range(CYCLES):
        percepts = {PERCEPTS[cycle % len(PERCEPTS)]} if cycle % 2 else None
        messages = [Message("user", "achieve", "g(1)")] if cycle == 3 else []
        outcome = agent.cycle(percepts, messages, finished, cycle * 0.1)
        finished = [Finished(action.id, "blocked" if action.id % 5 == 0 else None) for action in outcome.actions]
    return True


def check(text: str, report: Report) -> None:
    """Raises whatever must not be raised."""
    report.cases += 1
    program = read(text)
    if program is None:
        return
    report.read += 1
    reread(program)
    report.run += run(program)


# ---- where the texts come from -------------------------------------------------------------------------------------


def real_programs() -> list[str]:
    """The examples, and the recorded cases where they lie beside the checkout."""
    folders = [ROOT / "examples", ROOT / "robot", ROOT.parent / "shared" / "cases"]
    paths = sorted(path for folder in folders for path in folder.rglob("*.asl"))
    return [text for path in paths if len(text := path.read_text(encoding="utf-8")) <= LONGEST_TEXT]


def mangled(random: random.Random, programs: list[str]) -> str:
    """A real program after one to four accidents."""
    text = random.choice(programs)
    for _ in range(random.randint(1, 4)):
        text = random.choice(_ACCIDENTS)(random, text, programs)[:LONGEST_TEXT]
    return text


_TOKEN = re.compile(r"\s+|\w+|[^\w\s]")
_PIECES = (
    *"+-!?^@.,;:|&~()[]{}<>=*/'\"\\_%#\0\n 0",
    *("<-", ":-", "<:", "!!", "|&|", "|||", "**", "\\==", "=..", "::", "-+", "++", "/*", "*/", "//"),
    *("not", "if", "else", "elif", "while", "for", "div", "mod", "true", "begin", "end", "and", "or"),
    *("X", "_", "p", "q(1)", "[a|T]", "{a; b}", "{+!g <- a}", "1e3", '"s"', "'x y'", ".print(X)", "é", "\ud800"),
)


def _cut(random: random.Random, text: str) -> tuple[str, str, str]:
    parts = _TOKEN.findall(text)
    start = random.randint(0, len(parts))
    end = min(len(parts), start + random.choice((1, 1, 1, 2, 5, 20)))
    return "".join(parts[:start]), "".join(parts[start:end]), "".join(parts[end:])


def _drop(random: random.Random, text: str, programs: list[str]) -> str:
    before, _, after = _cut(random, text)
    return before + after


def _double(random: random.Random, text: str, programs: list[str]) -> str:
    before, piece, after = _cut(random, text)
    return before + piece * random.choice((2, 2, 3, 30)) + after


def _put(random: random.Random, text: str, programs: list[str]) -> str:
    before, piece, after = _cut(random, text)
    return before + random.choice(_PIECES) + (piece if random.random() < 0.5 else "") + after


def _graft(random: random.Random, text: str, programs: list[str]) -> str:
    before, _, after = _cut(random, text)
    return before + _cut(random, random.choice(programs))[1] + after


def _swap(random: random.Random, text: str, programs: list[str]) -> str:
    before, piece, after = _cut(random, text)
    first, second, rest = _cut(random, after)
    return before + second + first + piece + rest


def _end(random: random.Random, text: str, programs: list[str]) -> str:
    return text[: random.randint(0, len(text))]


_ACCIDENTS: tuple[Callable[[random.Random, str, list[str]], str], ...] = (_drop, _double, _put, _graft, _swap, _end)


class Author:
    """Writes programs at random that mostly are some."""

    def __init__(self, random: random.Random) -> None:
        self.random = random

    def one(self, *choices: Callable[[int], str] | str, deep: int) -> str:
        choice = self.random.choice(choices[: max(1, len(choices) - deep)] if deep > 0 else choices)
        return choice if isinstance(choice, str) else choice(deep + 1)

    def several(self, part: Callable[[int], str], separator: str, deep: int, least: int = 0) -> str:
        return separator.join(part(deep + 1) for _ in range(self.random.randint(least, 3)))

    def name(self) -> str:
        return self.random.choice(("p", "q", "g", "h", "b", "n::p", "'a b'", "end", "begin", "p.x", "~q", "mod"))

    def literal(self, deep: int) -> str:
        args = f"({self.several(self.term, ',', deep, 1)})" if self.random.random() < 0.5 and deep < 6 else ""
        annots = f"[{self.several(self.term, ',', deep)}]" if self.random.random() < 0.15 and deep < 6 else ""
        return self.name() + args + annots

    def term(self, deep: int) -> str:
        return self.one(
            "X",
            "Y",
            "_",
            "1",
            "2.5",
            ".5",
            "1e3",
            '"s\\n"',
            "a",
            self.literal,
            lambda deep: f"[{self.several(self.term, ',', deep, 1)}|T]",
            lambda deep: f"[{self.several(self.term, ',', deep)}]",
            lambda deep: f"({self.formula(deep)})",
            lambda deep: f"{self.term(deep)} {self.random.choice(('+', '-', '*', '/', 'div', 'mod', '**'))} a",
            lambda deep: f"-{self.term(deep)}",
            lambda deep: f"X[{self.several(self.term, ',', deep, 1)}]",
            lambda deep: f"{{ {self.body(deep)} }}",
            lambda deep: f"{{ +!{self.literal(deep)} : {self.formula(deep)} <- {self.body(deep)} }}",
            lambda deep: f"{{ {self.literal(deep)} :- {self.formula(deep)} }}",
            deep=deep,
        )

    def formula(self, deep: int) -> str:
        return self.one(
            "true",
            "X",
            "p(X)",
            self.literal,
            lambda deep: f"{self.term(deep)} {self.random.choice(('<', '<=', '>', '>=', '==', '=', '=..'))} 2",
            lambda deep: f"not {self.formula(deep)}",
            lambda deep: f"{self.formula(deep)} & {self.formula(deep)}",
            lambda deep: f"{self.formula(deep)} | {self.formula(deep)}",
            lambda deep: f"({self.formula(deep)})",
            lambda deep: f".member(X,{self.term(deep)})",
            deep=deep,
        )

    def step(self, deep: int) -> str:
        signs = ("!", "!!", "?", "+", "-", "++", "--", "-+", "+<", "+>", "")
        return self.one(
            "a",
            "!g(X)",
            "+b",
            lambda deep: self.random.choice(signs) + self.literal(deep),
            lambda deep: self.random.choice(signs) + self.literal(deep),
            lambda deep: f"X = {self.term(deep)}",
            lambda deep: f".print({self.term(deep)})",
            lambda deep: f"?({self.formula(deep)})",
            lambda deep: f"if ({self.formula(deep)}) {{ {self.body(deep)} }} else {{ {self.body(deep)} }}",
            lambda deep: f"for ({self.formula(deep)}) {{ {self.body(deep)} }}",
            lambda deep: f"({self.body(deep)}) {self.random.choice(('|&|', '|||'))} {self.step(deep)}",
            lambda deep: f"({self.body(deep)})",
            lambda deep: f"{self.random.choice(signs[:5])}{self.term(deep)}",
            deep=deep,
        )

    def body(self, deep: int) -> str:
        return self.several(self.step, "; ", deep)

    def plan(self, deep: int) -> str:
        trigger = self.random.choice(("+!", "-!", "+", "-", "+?", "-?", "^!"))
        label = self.random.choice(("", "", f"@l{self.random.randint(1, 99)} ", "@[atomic] "))
        head = self.random.choice(("G", "G[error(E)]", "g(1)", "g(X)", "p(1)", self.literal(3)))
        context = f" : {self.formula(1)}" if self.random.random() < 0.5 else ""
        return f"{label}{trigger}{head}{context} <- {self.body(0)}."

    def clause(self) -> str:
        return self.random.choice(
            (
                lambda: f"{self.literal(2)}.",
                lambda: f"{self.literal(4)} :- {self.formula(0)}.",
                lambda: f"!{self.literal(3)}.",
                lambda: self.plan(0),
                lambda: self.plan(0),
                lambda: f"{{ begin namespace(n) }} {self.plan(1)} {{ end }}",
            )
        )()

    def program(self) -> str:
        return "\n".join(self.clause() for _ in range(self.random.randint(1, 6)))


def texts(seed: int) -> Iterator[str]:
    """Mangled real programs and made-up ones, without end; the same for the same seed."""
    chance = random.Random(seed)
    programs, author = real_programs(), Author(chance)
    while True:
        yield mangled(chance, programs)
        made = author.program()
        yield made
        yield mangled(chance, [made])


# ---- the command ---------------------------------------------------------------------------------------------------


def measure(cases: int, seed: int, longest_s: float = 0) -> Report:
    """With `longest_s` a case that takes longer fails; it needs the alarm clock of the process."""
    report = Report()
    if longest_s:
        signal.signal(signal.SIGALRM, _hang)
    for _, text in zip(range(cases), texts(seed), strict=False):
        began_s = time.perf_counter()
        if longest_s:
            signal.setitimer(signal.ITIMER_REAL, longest_s)
        try:
            check(text, report)
        except Exception as error:
            where = traceback.extract_tb(error.__traceback__)[-1]
            place = f"{Path(where.filename).name}:{where.lineno}"
            report.failures.append({"text": text, "error": f"{type(error).__name__}: {error}"[:1000], "place": place})
        finally:
            if longest_s:
                signal.setitimer(signal.ITIMER_REAL, 0)
        took_s = time.perf_counter() - began_s
        if took_s > report.slowest_s:
            report.slowest_s, report.slowest = round(took_s, 4), text
    return report


def _hang(number: int, frame: FrameType | None) -> None:
    raise Hang("this takes too long")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path, help="write the whole report here")
    options = parser.parse_args()
    report = measure(options.cases, options.seed, LONGEST_S)
    if options.json:
        options.json.write_text(json.dumps(asdict(report), indent=1), encoding="utf-8")
    summary = {**asdict(report), "failures": len(report.failures)}
    sys.stdout.write(json.dumps(summary) + "\n")
    return 1 if report.failures else 0


if __name__ == "__main__":
    raise SystemExit(main())
