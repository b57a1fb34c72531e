"""Charging, in a campus on which robots run low: no robot may strand, and hardly any order wait for an unplanned
charge.

    python -m benchmarks.fleet charging

Everything is simulated, with `fleet.charging` deciding. Six robots with packs that are worn more or less, four docks,
the Carleton tunnels at 0.2 m/s, days with rush hours, corridors that are closed for up to an hour. Beside it what there
was before: work from 30 % on, home to a dock when there is none. Left out: other robots are in the way as random waits
(the traffic has parts of its own), and a robot carries one item. A robot that strands is carried to where it can go on.
"""

from dataclasses import dataclass
from typing import Any, Final

from benchmarks.body.report import Wanted
from benchmarks.fleet.charging_fleet import FleetRun
from benchmarks.fleet.charging_policies import Predicting, Reacting
from benchmarks.fleet.samples import Samples

POLICIES: Final = {"predicting": Predicting, "reacting": Reacting}
ORDERS_H: Final = {"usual": 0.8, "more_than_docks_give": 1.3}
"""Orders in an hour of the week, on average; twice as many in the busiest."""
ROBOTS: Final = 6
MOST_UNPLANNED: Final = 0.02

WANTED = (
    Wanted("usual.predicting.stranded", at_most=0),
    Wanted("usual.predicting.unplanned_share", at_most=MOST_UNPLANNED),
    Wanted("usual.predicting.cost_exceeded_share", at_most=0.04),
    Wanted("usual.predicting.delivered_share", at_least=0.97),
    Wanted("more_than_docks_give.predicting.stranded", at_most=0),
    Wanted("more_than_docks_give.predicting.unplanned_share", at_most=MOST_UNPLANNED),
)


@dataclass(frozen=True)
class Run:
    """One week, more or less, of one fleet."""

    policy: str
    load: str
    seed: int
    days: float


@dataclass
class Seen:
    """`unplanned`: orders whose robot broke off to charge; `on_the_way`: orders that were more than one charge, known
    before; `waited`: orders that had to wait for a robot while one was there that had to charge first."""

    orders: int = 0
    delivered: int = 0
    stranded: int = 0
    unplanned: int = 0
    on_the_way: int = 0
    waited: int = 0
    predicted: int = 0
    exceeded: int = 0
    time_s: float = 0.0

    def __add__(self, other: "Seen") -> "Seen":
        return Seen(*(mine + theirs for mine, theirs in zip(vars(self).values(), vars(other).values(), strict=True)))

    def figures(self) -> dict[str, Any]:
        return {
            **vars(self),
            "delivered_share": self.delivered / max(1, self.orders),
            "unplanned_share": self.unplanned / max(1, self.orders),
            "on_the_way_share": self.on_the_way / max(1, self.orders),
            "waited_share": self.waited / max(1, self.orders),
            "cost_exceeded_share": self.exceeded / max(1, self.predicted),
            "mean_order_min": self.time_s / max(1, self.delivered) / 60,
        }


def measure(samples: Samples) -> dict[str, Any]:
    runs = [
        Run(policy, load, seed, samples.days)
        for load in ORDERS_H
        for policy in POLICIES
        for seed in samples.some_seeds()
    ]
    seen = {load: dict.fromkeys(POLICIES, Seen()) for load in ORDERS_H}
    for run, found in zip(runs, samples.each(look_at, runs), strict=True):
        seen[run.load][run.policy] += found
    return {load: {name: one.figures() for name, one in policies.items()} for load, policies in seen.items()}


def look_at(run: Run) -> Seen:
    fleet = FleetRun(run.seed, POLICIES[run.policy], ROBOTS, ORDERS_H[run.load])
    fleet.run(run.days)
    done = [job for job in fleet.jobs if job.is_done]
    return Seen(
        orders=len(fleet.jobs),
        delivered=len(done),
        stranded=len(fleet.stranded),
        unplanned=sum(job.unplanned for job in fleet.jobs),
        on_the_way=sum(job.planned for job in fleet.jobs),
        waited=sum(job.kept_waiting_by_charge for job in fleet.jobs),
        predicted=len(fleet.predicted),
        exceeded=sum(spent > most for most, spent in fleet.predicted),
        time_s=sum(job.done_s - job.placed_s for job in done),
    )
