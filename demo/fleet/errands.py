"""Errands: sender, post and recipient, drawn from a seed."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from random import Random

from demo.fleet.campus import Campus
from maps import shortest_route

DOMAIN = "campus.example"
HIGH, LOW, LATER, ABSENT = 0.15, 0.15, 0.15, 0.12
"""How many of the orders are urgent, can wait, are for later, or meet a recipient who does not come."""
LATER_S = (120.0, 600.0)


@dataclass(frozen=True)
class Errand:
    """One order. `absent`: its recipient does not come to the robot. `later_s`: not to be fetched before that."""

    sender: str
    recipient: str
    priority: str = "normal"
    later_s: float | None = None
    absent: bool = False


def address(name: str) -> str:
    return f"{name}@{DOMAIN}"


def first_errands(campus: Campus) -> Iterator[Errand]:
    """A letter beside every robot's home, so that all of them set out; to a person near, each to another if there are
    enough people."""
    homes, told = [campus.map.address_of(home) for home in campus.homes.values()], set[str]()
    for home in homes:
        sender, *others = sorted(campus.offices, key=lambda name: _distance_m(campus, home, name))
        recipient = next((name for name in others if name not in told and campus.offices[name] not in homes), others[0])
        told.add(recipient)
        yield Errand(sender, recipient)


def _distance_m(campus: Campus, home: str, person: str) -> float:
    return shortest_route(campus.map, home, campus.offices[person]).length_m


def errands(seed: int, people: Collection[str]) -> Iterator[Errand]:
    """Without end."""
    draw = Random(f"{seed}/errands")
    while True:
        sender, recipient = draw.sample(sorted(people), 2)
        priority = draw.choices(("high", "low", "normal"), (HIGH, LOW, 1 - HIGH - LOW))[0]
        later_s = draw.uniform(*LATER_S) if draw.random() < LATER else None
        yield Errand(sender, recipient, priority, later_s, draw.random() < ABSENT)
