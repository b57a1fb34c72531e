"""The same demand as if robots could pass through each other: what the figures of a fleet are compared with."""

import heapq
from math import inf

from benchmarks.fleet.demand import HANDLING_S, Saturated
from benchmarks.fleet.grounds import Ground


def delivered(ground: Ground, robots: int, seed: int, hours: float, *, nearest: bool, age_limit_s: float = inf) -> int:
    """Return the orders delivered in so many hours: first come first served, or always the nearest one that waits,
    unless one has waited too long."""
    way_s = ground.network.shortest_s
    demand = Saturated(len(ground.network.posts), seed)
    free = [(0.0, number, home) for number, home in enumerate(ground.homes(robots).values())]
    heapq.heapify(free)
    count = 0
    while free[0][0] < hours * 3600:
        now_s, robot, post = heapq.heappop(free)
        oldest = demand.waiting[0]
        order = min(demand.waiting, key=lambda one: (way_s[post][one.start] if nearest else 0.0, one.number))
        if now_s - oldest.placed_s > age_limit_s:
            order = oldest
        demand.take(order, now_s)
        done_s = now_s + way_s[post][order.start] + way_s[order.start][order.end] + 2 * HANDLING_S
        count += done_s <= hours * 3600
        heapq.heappush(free, (done_s, robot, order.end))
    return count
