"""The figures measured, and their targets."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from benchmarks.mind.engines import Engine
from benchmarks.mind.workloads import FACTS, LOOK_UPS, STRIDE

Sample: TypeAlias = Mapping[str, float]
OURS = ("ours",)
PYTHON = ("ours", "python-agentspeak")
ALL = ("ours", "python-agentspeak", "jason")


@dataclass(frozen=True, slots=True)
class Sizes:
    """The amount that is run. Figures of a quick run say that everything works, not how long it takes."""

    paper: int = 3_000  # the recorded cycles, once: short rounds, many of them, since others use the machine too
    first: int = 1_000
    counter: int = 100_000
    fib: int = 18
    percepts: int = 40  # sets made beforehand: more of them would be out of the cache by the time they are used
    memory: int = 20_000
    growth: int = 1_000_000
    look_ups: tuple[int, int, int] = (900, 4, 100)  # in the order of ALL


FULL = Sizes()
QUICK = Sizes(1_000, 300, 2_000, 10, 20, 1_000, 5_000, (20, 1, 2))


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the table. `sample` measures once; its `value` is what the targets are about.

    `at_most` is for ours and judged by the least of the rounds (the rest is what else the machine did), or by their
    median where it is a quotient; `ratio_at_most` is for ours divided by python-agentspeak's.
    """

    name: str
    unit: str
    what: str
    sample: Callable[[Engine, Sizes], Sample]
    at_most: float | None = None
    ratio_at_most: float | None = None
    engines: tuple[str, ...] = ALL
    rounds: int = 7
    warm: bool = True
    judged_by: str = "least"


def _per(answer: Mapping[str, Any], units: float, factor: float) -> Sample:
    return {"value": answer["cpu_s"] / units * factor}


def paper(engine: Engine, sizes: Sizes) -> Sample:
    answer = engine.ask(f"script paper {sizes.paper}")
    return {**_per(answer, sizes.paper, 1e6), "actions": answer["actions"]}


def paper_each(engine: Engine, sizes: Sizes) -> Sample:
    answer = engine.ask(f"each paper {sizes.paper}")
    return {"value": answer["p99_us"], **answer}


def first_cycles(engine: Engine, sizes: Sizes) -> Sample:
    return _per(engine.ask_afresh(f"script paper {sizes.first}"), sizes.first, 1e6)


def counter(engine: Engine, sizes: Sizes) -> Sample:
    return _per(engine.ask(f"goal counter go({sizes.counter})"), 1, 1e3)


def fib_rules(engine: Engine, sizes: Sizes) -> Sample:
    return _per(engine.ask(f"goal fib_rules go({sizes.fib})"), 1, 1e3)


def fib_goals(engine: Engine, sizes: Sizes) -> Sample:
    return _per(engine.ask(f"goal fib_goals go({sizes.fib})"), 1, 1e3)


def look_up(engine: Engine, sizes: Sizes) -> Sample:
    """One look-up; the loop around it is taken away. The keys lie around the middle, for those who search in order."""
    rounds = sizes.look_ups[ALL.index(engine.name)]
    first = (FACTS + rounds * STRIDE) // 2
    goal = f"go({first},{first - rounds * STRIDE})"
    loop_s = engine.ask(f"goal no_look_up {goal}")["cpu_s"]
    all_s = engine.ask(f"goal look_up {goal}")["cpu_s"]
    return {"value": (all_s - loop_s) / (rounds * LOOK_UPS) * 1e6}


def percepts(engine: Engine, sizes: Sizes) -> Sample:
    return _per(engine.ask(f"script percepts {sizes.percepts}"), sizes.percepts, 1e6)


def first_action(engine: Engine, sizes: Sizes) -> Sample:
    used = engine.first_action(compiled=True)
    return {"value": used["cpu_s"] * 1e3, "wall_ms": used["wall_s"] * 1e3}


def first_start(engine: Engine, sizes: Sizes) -> Sample:
    used = engine.first_action(compiled=False)
    return {"value": used["cpu_s"] * 1e3, "wall_ms": used["wall_s"] * 1e3}


def memory(engine: Engine, sizes: Sizes) -> Sample:
    return {"value": engine.ask_afresh(f"memory paper {sizes.memory}")["peak_mib"]}


def growth(engine: Engine, sizes: Sizes) -> Sample:
    answer = engine.ask_afresh(f"growth paper {sizes.growth}")
    return {"value": answer["grown_mib"], **answer}


def tracing(engine: Engine, sizes: Sizes) -> Sample:
    off = engine.ask(f"script paper {sizes.paper}")["cpu_s"]
    on = engine.ask(f"traced paper {sizes.paper}")["cpu_s"]
    return {"value": on / off, "off_us": off / sizes.paper * 1e6, "on_us": on / sizes.paper * 1e6}


FIGURES = (
    Figure("paper", "µs", "CPU per cycle of the paper's agent, warm", paper, 4, 0.42, rounds=60),
    Figure("paper_p99", "µs", "99 of 100 cycles of it take at most this, by the clock on the wall", paper_each, 15,
           rounds=20),
    Figure("first_cycles", "µs", "CPU per cycle of the first 1,000 cycles of a process", first_cycles),
    Figure("counter", "ms", "a recursive goal that counts 100,000 steps", counter, 150, 0.07, rounds=5),
    Figure("fib_rules", "ms", "fib(18) by rules", fib_rules, None, 0.1, rounds=5),
    Figure("fib_goals", "ms", "fib(18) by sub-goals", fib_goals),
    Figure("look_up", "µs", "one of 10,000 beliefs by its bound first argument", look_up, 3, rounds=5),
    Figure("percepts", "µs", "CPU per cycle with 500 percepts of which 50 change", percepts, 60, rounds=60),
    Figure("first_action", "ms", "CPU of a process from its start to the first action", first_action, 150, rounds=10),
    Figure("first_start", "ms", "the same, when no module has been compiled before", first_start, engines=PYTHON,
           rounds=3, warm=False),
    Figure("memory", "MiB", "the most memory that a process running the paper's agent holds", memory, 30,
           engines=PYTHON, rounds=1, warm=False),
    Figure("growth", "MiB", "what a process grows by between cycle 100,000 and 1,000,000", growth, 0.5,
           engines=OURS, rounds=1, warm=False),
    Figure("tracing", "times", "CPU with a listener, of that without", tracing, 3, engines=OURS, rounds=20,
           judged_by="median"),
)  # fmt: skip
