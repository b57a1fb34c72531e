"""The planner beside the event loop: as good as one made in it, and no caller waits for it in vain."""

import asyncio
import os
import signal
import threading
from collections.abc import AsyncIterator
from dataclasses import replace
from random import Random
from typing import Any, ClassVar

import pytest

from app.dispatch.planner_process import PlannerProcess
from fleet.assignment.deciding import Decision
from fleet.assignment.problem import OpenOrder
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import decided, problem_of, robot, street

BUDGET_S = 0.05


@pytest.fixture
def decision() -> Decision:
    orders = [order(0, 1, 2), order(1, 3, 2), order(2, 1, 4)]
    return decided(problem_of(street(5), {"r0": robot(0, capacity=2), "r1": robot(4, capacity=2)}, orders))


@pytest.fixture
async def process() -> AsyncIterator[PlannerProcess]:
    process = PlannerProcess()
    yield process
    await process.end()


async def test_it_finds_a_plan_that_serves_the_same_orders_and_is_no_dearer(
    process: PlannerProcess, decision: Decision
) -> None:
    better = await process.improved(decision, BUDGET_S)
    assert better is not None
    assert better.robot_of().keys() == decision.robot_of().keys()
    assert better.cost_s <= decision.cost_s


class Asked(dict[str, OpenOrder]):
    """Orders that know which threads looked at them."""

    threads: ClassVar[set[int]] = set()

    def values(self) -> Any:
        self.threads.add(threading.get_ident())
        return super().values()


async def test_the_first_answer_is_made_beside_the_event_loop(process: PlannerProcess, decision: Decision) -> None:
    problem = replace(decision.problem, orders=Asked(decision.problem.orders))
    first = await process.decided(problem, Random(0))
    assert first is not None
    assert first.robot_of() == decision.robot_of()
    assert Asked.threads
    assert threading.get_ident() not in Asked.threads


async def test_two_who_ask_at_once_are_answered_in_turn(process: PlannerProcess, decision: Decision) -> None:
    both = await asyncio.gather(process.improved(decision, BUDGET_S), process.improved(decision, BUDGET_S))
    assert [better is not None for better in both] == [True, True]


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP], ids=["dies", "hangs"])
@pytest.mark.slow
async def test_one_that_fails_is_ended_and_the_next_question_starts_another(
    process: PlannerProcess, decision: Decision, how: signal.Signals
) -> None:
    await process.improved(decision, BUDGET_S)
    first = process.process_id
    assert first is not None
    os.kill(first, how)
    failed = await process.improved(decision, BUDGET_S)
    again = failed or await process.improved(decision, BUDGET_S)
    assert again is not None, "a dead one may have been seen before it was asked"
    assert process.process_id not in (None, first)
    with pytest.raises(ProcessLookupError):
        os.kill(first, 0)
