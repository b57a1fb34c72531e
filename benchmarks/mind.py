"""How long the mind takes: python -m benchmarks.mind prints JSON. CPU time, warm, the best of several runs.

paper_us_per_cycle      the paper's agent on its recorded percepts (needs the records, see shared/cases)
counter_100000_ms       a recursive goal that counts to 100,000, two cycles a step
look_up_us              one belief among 10,000 by its first argument
percepts_us_per_cycle   500 percepts of which 50 change in every cycle
first_action_ms         parse a program, make the agent, start its first action (once, cold but for imports)
"""

import gzip
import json
import time
from collections.abc import Callable
from pathlib import Path

from bdi import Agent, Finished, Message, load_program, parse_program

CASES = Path(__file__).parents[2] / "shared" / "cases" / "paper"
REPEATS = 5


def best_s(work: Callable[[], object]) -> float:
    """Shortest CPU time of a few runs."""
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def paper_us_per_cycle(cycles: int = 50_000) -> float | None:
    if not CASES.exists():
        return None
    with gzip.open(CASES / "trace.jsonl.gz", "rt") as lines:
        rows = [json.loads(line) for line in lines]
    inputs = [
        (frozenset(row["percepts"]), [Message("user", "achieve", row["achieve"])] if row["achieve"] else ())
        for row in rows
    ]
    script = (inputs * (cycles // len(inputs) + 1))[:cycles]
    agent = Agent(load_program(CASES / "mail.asl"))

    def run() -> None:
        finished: list[Finished] = []
        cycle = agent.cycle
        for percepts, messages in script:
            outcome = cycle(percepts, messages, finished, 0.0)
            finished = [Finished(outcome.actions[0].id)] if outcome.actions else []

    return best_s(run) / cycles * 1e6


def counter_ms(limit: int = 100_000) -> float:
    program = parse_program(f"!count(0). +!count({limit}) <- done. +!count(N) <- !count(N+1).")

    def run() -> None:
        cycle = Agent(program).cycle
        while not cycle().actions:
            pass

    return best_s(run) * 1e3


def fib_by_rules_ms(number: int = 18) -> float:
    rules = "fib(0,0). fib(1,1). fib(N,F) :- N > 1 & fib(N-1,A) & fib(N-2,B) & F = A+B."
    agent = Agent(parse_program(rules))
    assert agent.believes("fib(10,55)")
    return best_s(lambda: agent.ask(f"fib({number},F)")) * 1e3


def look_up_us(facts: int = 10_000, times: int = 2_000) -> float:
    program = "".join(f"at({n},place{n % 7}). " for n in range(facts))
    loop = f"!go(0). +!go({times}) <- done. +!go(N) : at(N+5000,P) <- !go(N+1)."
    empty = f"!go(0). +!go({times}) <- done. +!go(N) : at(1,P) <- !go(N+1)."

    def run_of(text: str) -> Callable[[], None]:
        parsed = parse_program(text)

        def run() -> None:
            cycle = agents.pop().cycle
            while not cycle().actions:
                pass

        agents = [Agent(parsed) for _ in range(REPEATS)]
        return run

    return (best_s(run_of(program + loop)) - best_s(run_of("at(1,p). " + empty))) / times * 1e6


def percepts_us_per_cycle(percepts: int = 500, changed: int = 50, cycles: int = 400) -> float:
    agent = Agent(parse_program("+seen(0,_) <- act."))
    script = [
        frozenset(f"seen({n},{step % 7 if n < changed else 0})" for n in range(percepts)) for step in range(cycles)
    ]

    def run() -> None:
        for each in script:
            agent.cycle(each)

    return best_s(run) / cycles * 1e6


def first_action_ms() -> float:
    start = time.process_time()
    agent = Agent(parse_program("!a. +!a <- act."))
    assert agent.cycle().actions
    return (time.process_time() - start) * 1e3


if __name__ == "__main__":
    figures = {
        "first_action_ms": first_action_ms(),
        "paper_us_per_cycle": paper_us_per_cycle(),
        "counter_100000_ms": counter_ms(),
        "fib_18_by_rules_ms": fib_by_rules_ms(),
        "look_up_us": look_up_us(),
        "percepts_us_per_cycle": percepts_us_per_cycle(),
    }
    print(json.dumps({name: None if value is None else round(value, 2) for name, value in figures.items()}, indent=2))
