"""A route optimiser as a yardstick: VROOM, solved anew at every event. It knows ways and stops, no conflicts.

What it answers is executed under the same traffic rules as everything else. It minimises driving; each robot is given
no more than its share of the waiting orders, or it would leave robots idle. A robot that has an order is ready where
that goes, when the schedule says.
"""

from collections.abc import Sequence
from math import ceil

import numpy as np
import vroom

from benchmarks.fleet.demand import HANDLING_S, Order
from benchmarks.fleet.world import World

EXPLORATION = 5
"""The most that it does by default."""


def next_orders(world: World, robots: Sequence[str], waiting: Sequence[Order]) -> list[tuple[str, Order]]:
    """For each of these robots the first order of its route, if it has one."""
    problem = vroom.Input()
    problem.set_durations_matrix("car", np.array(world.network.shortest_s).round().astype(np.uint32))
    share = 2 * ceil(len(waiting) / len(robots))
    tasks, journeys = world.known()
    for number, robot in enumerate(robots):
        task = tasks[robot]
        post = task.goals[-1].post if task.goals else task.start.post
        soonest_s = int(max(0.0, journeys[robot].done_s - world.now_s))
        window = vroom.TimeWindow(soonest_s, 10_000_000)
        problem.add_vehicle(vroom.Vehicle(number, post, capacity=[1], time_window=window, max_tasks=share))
    for number, order in enumerate(waiting):
        load, give = (vroom.ShipmentStep(number, post, default_service=int(HANDLING_S)) for post in order[1:3])
        problem.add_shipment(load, give, vroom.Amount([1]))
    routes = problem.solve(exploration_level=EXPLORATION, nb_threads=1).routes
    loads = routes[routes["type"] == "pickup"].drop_duplicates("vehicle_id")
    pairs = zip(loads["vehicle_id"], loads["id"], strict=True)
    return [(robots[int(vehicle)], waiting[int(number)]) for vehicle, number in pairs]
