"""A mind that runs for days must not grow: after its first thousands of cycles it holds what it will hold for ever."""

import gc
import sys
from collections import Counter
from collections.abc import Callable

import pytest

from bdi import Agent, Finished, Message, parse_program
from bdi.model.logic.logic import REMEMBERED_FORMULAS
from tests.own_process import in_own_process

# A robot's life in small: missions by message, percepts that flicker, failures, waits, a goal for ever, beliefs that
# come and go, drops and atomic plans.
ROBOT = """
home(post0).
near(P) :- home(P) | at(P).

!watch(0).
+!watch(N) : N > 20 <- !watch(0).
+!watch(N) <- !watch(N+1).

+!deliver(From,To) <- +mission(From,To); !travel(From,1); !travel(To,1); -mission(From,To).

+!travel(P,_) : at(P) <- .print("at ", P).
+!travel(P,N) : line(center) <- drive(P); !travel(P,N+1).
+!travel(P,N) <- turn(left); !travel(P,N).
-!travel(P,N)[error(E)] <- .wait(50); !travel(P,N).

@low[atomic]
+battery(low) : mission(From,To) <-
  .drop_all_intentions;
  .findall(P, near(P), Near);
  -mission(From,To);
  !charge;
  !!watch(0).
+!charge : battery(ok).
+!charge <- dock; !charge.

-line(L) <- -+lost(L).
"""
WARM_UP, CYCLES = 10_000, 100_000
FEW = 400  # what so many cycles may leave behind: far less than one object for each


def run_of(agent: Agent, acted: Counter[str]) -> Callable[[int], None]:
    """Return a function that runs so many more cycles and counts the actions; every seventh action fails."""
    finished: list[Finished] = []
    number = 0

    def run(cycles: int) -> None:
        nonlocal finished, number
        for _ in range(cycles):
            number += 1
            percepts = {f"line({('center', 'left', 'lost')[number // 9 % 3]})", f"at(post{number // 20 % 4})"}
            percepts.add("battery(low)" if number % 500 > 450 else "battery(ok)")
            messages = [Message("user", "achieve", f"deliver(post{number % 4},post2)")] if number % 50 == 0 else ()
            outcome = agent.cycle(percepts, messages, finished, number / 10)
            acted.update(action.term.functor for action in outcome.actions)
            finished = [
                Finished(action.id, "bumped") if action.id % 7 == 0 else Finished(action.id)
                for action in outcome.actions
            ]

    return run


@pytest.mark.slow
def test_a_hundred_thousand_cycles_leave_nothing_behind() -> None:
    acted, objects, blocks = in_own_process(a_hundred_thousand_cycles)
    assert min(acted[name] for name in ("drive", "turn", "dock")) > 1000
    assert objects < FEW
    assert blocks < FEW


def a_hundred_thousand_cycles() -> tuple[Counter[str], int, int]:
    """Run cycles; return the actions, and the objects and blocks of memory that are left."""
    acted: Counter[str] = Counter()
    run = run_of(Agent(parse_program(ROBOT)), acted)
    run(WARM_UP)
    before = held()
    run(CYCLES)
    objects, blocks = (now - then for now, then in zip(held(), before, strict=True))
    return acted, objects, blocks


@pytest.mark.slow
def test_no_plan_or_question_is_remembered_that_is_gone() -> None:
    """A relation knows what was compiled with it; plans and questions that come and go leave nothing there."""
    objects, blocks = in_own_process(plans_and_questions_come_and_go)
    assert objects < FEW
    assert blocks < FEW


def plans_and_questions_come_and_go() -> tuple[int, int]:
    """Return the objects and blocks of memory that a round leaves. After each whole round as many questions are
    remembered as ever are: in between it may be a hundred or all."""
    agent = Agent(
        parse_program("q(a). +!go(N) <- .add_plan({ @p +!h : q(_) <- true }); !h; .remove_plan(p); !go(N+1).")
    )
    agent.cycle(None, [Message("tester", "achieve", "go(0)")])
    sizes = []
    for number in range(3 * REMEMBERED_FORMULAS):
        agent.cycle()
        agent.ask(f"q(X) & not q(b{number})")
        if (number + 1) % REMEMBERED_FORMULAS == 0:
            sizes.append(held())
    objects, blocks = (now - then for now, then in zip(sizes[-1], sizes[-2], strict=True))
    return objects, blocks


def held() -> tuple[int, int]:
    """The objects that can hold others, and all blocks of memory (numbers and texts too)."""
    gc.collect()
    return len(gc.get_objects()), sys.getallocatedblocks()
