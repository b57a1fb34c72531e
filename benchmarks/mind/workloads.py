"""The workloads: the programs and percepts, written as files that every interpreter reads.

A script has one line a cycle: the percepts, separated by spaces, a tabulator, and the goal to achieve, if any.
"""

import gzip
import json
import random
from collections.abc import Iterable, Iterator
from pathlib import Path

HERE = Path(__file__).parent
RECORDED = HERE.parents[2] / "shared" / "cases" / "paper"

FACTS = 10_000
PERCEPTS, CHANGING = 500, 50
PERCEPT_CYCLES = 200

COUNTER = """
+!go(0) <- done.
+!go(N) <- !go(N-1).
"""
FIB_RULES = """
fib(0,0).
fib(1,1).
fib(N,F) :- N > 1 & fib(N-1,A) & fib(N-2,B) & F = A+B.
+!go(N) : fib(N,F) <- done.
"""
FIB_GOALS = """
+!fib(0,0).
+!fib(1,1).
+!fib(N,F) : N > 1 <- !fib(N-1,A); !fib(N-2,B); F = A+B.
+!go(N) <- !fib(N,F); done.
"""
LOOK_UPS = 10  # in one context, so that the loop around them is the smaller part
STRIDE = 11  # from one key to the next
LOOK_UP = f"""
+!go(N,N) <- done.
+!go(N,M) : {" & ".join(f"at(N,P{number})" for number in range(LOOK_UPS))} <- !go(N-{STRIDE},M).
"""
NO_LOOK_UP = f"""
+!go(N,N) <- done.
+!go(N,M) <- !go(N-{STRIDE},M).
"""
SEEN = "+seen(0,_) <- done.\n"


def write_workloads(folder: Path, recorded: Path = RECORDED) -> str:
    """Write every program and script. Returns which agent the workload called paper is: the recorded one or ours."""
    folder.mkdir(parents=True, exist_ok=True)
    facts = "".join(f"at({number},place{number % 7}).\n" for number in range(FACTS))
    programs = {
        "counter": COUNTER,
        "fib_rules": FIB_RULES,
        "fib_goals": FIB_GOALS,
        "look_up": facts + LOOK_UP,
        "no_look_up": NO_LOOK_UP,
        "percepts": SEEN,
    }
    for name, text in programs.items():
        (folder / f"{name}.asl").write_text(text)
    _write_script(folder / "percepts.script", ((line, "") for line in _changing_percepts()))
    if recorded.exists():
        (folder / "paper.asl").write_text((recorded / "mail.asl").read_text())
        _write_script(folder / "paper.script", _recorded_script(recorded / "trace.jsonl.gz"))
        return "the paper's agent on its 3,000 recorded cycles"
    (folder / "paper.asl").write_text((HERE / "courier.asl").read_text())
    _write_script(folder / "paper.script", _toy_script(3000, random.Random(1)))
    return (
        "a stand-in, benchmarks/mind/courier.asl on made-up percepts: the paper's records are not beside this checkout"
    )


def _write_script(path: Path, lines: Iterable[tuple[str, str]]) -> None:
    path.write_text("".join(f"{percepts}\t{goal}\n" for percepts, goal in lines))


def _changing_percepts() -> Iterator[str]:
    for cycle in range(PERCEPT_CYCLES):
        yield " ".join(f"seen({n},{cycle % 7 if n < CHANGING else 0})" for n in range(PERCEPTS))


def _recorded_script(path: Path) -> Iterator[tuple[str, str]]:
    with gzip.open(path, "rt") as lines:
        for row in map(json.loads, lines):
            yield " ".join(row["percepts"]), row["achieve"] or ""


def _toy_script(cycles: int, chance: random.Random) -> Iterator[tuple[str, str]]:
    """A robot between eight posts that is sometimes at one, mostly on a line, and charges now and then."""
    target = "unknown"
    for cycle in range(cycles):
        level = cycle % 400
        percepts = [f"battery({'low' if level > 350 else 'full' if level < 40 else 'ok'})"]
        if cycle % 3 == 0:
            percepts.append(f"line({chance.choice(['center', 'center', 'center', 'left', 'right', 'lost', 'across'])})")
        if cycle % 20 < 2:
            target = f"post{chance.randrange(8)}"
            percepts.append(f"at({target},post{chance.randrange(8)})")
        if cycle % 20 < 4:
            way = chance.choice(["forward", "left", "right", "behind", "arrived"])
            percepts.append(f"direction({target},{way})")
        goal = f"deliver(post{chance.randrange(8)},post{chance.randrange(8)})" if cycle % 500 == 2 else ""
        yield " ".join(percepts), goal
