"""What a robot's delay weighs beside another's decides who goes first."""

from dataclasses import replace
from random import Random

import pytest

from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.planning import improve
from tests.app.dispatch.test_fleet_plan import street
from tests.fleet.schedule.test_schedules import planned


@pytest.mark.parametrize("heavy", ["east", "west"])
def test_of_two_that_meet_in_a_corridor_the_one_with_the_greater_weight_goes_first(heavy: str) -> None:
    network = street(4)
    tasks = {
        "east": Task(Start(0, True, 0.0, 0.0), (Goal(3, 10.0),), 0),
        "west": Task(Start(3, True, 0.0, 0.0), (Goal(0, 10.0),), 3),
    }
    tasks[heavy] = replace(tasks[heavy], weight=3.0)
    rounds = iter(range(20))
    found = improve(
        network, tasks, planned(Random(1), network, tasks), Random(1), lambda: next(rounds, None) is not None
    )
    done_s = {name: journey.done_s for name, journey in found.journeys.items()}
    assert done_s[heavy] == 310.0 < min(at_s for name, at_s in done_s.items() if name != heavy)
    assert found.cost_s == sum(tasks[name].weight * at_s for name, at_s in done_s.items())
