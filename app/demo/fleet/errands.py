"""Who sends what to whom in a demonstration of the fleet: drawn from a seed, so that it can be had again."""

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random
from typing import Final

DOMAIN = "campus.example"
OFFICES: Final = {
    "hana": "uc",
    "ben": "azrieli",
    "kim": "canal",
    "emil": "nicol",
    "ivo": "mackenzie",
    "fay": "frontenac",
    "jule": "commons",
    "ada": "library",
    "chloe": "loeb",
    "dora": "steacie",
    "gus": "cttc",
}
"""People, and the post next to each one's office."""
FIRST: Final = {"r1": ("hana", "ben"), "r2": ("kim", "emil"), "r3": ("ivo", "fay"), "r4": ("jule", "ada")}
"""At first a letter beside every robot's dock, so that all of them set out."""
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

    @property
    def posts(self) -> tuple[str, str]:
        return OFFICES[self.sender], OFFICES[self.recipient]


def address(name: str) -> str:
    return f"{name}@{DOMAIN}"


def first_errands(robots: list[str]) -> list[Errand]:
    return [Errand(*FIRST[robot]) for robot in robots]


def errands(seed: int) -> Iterator[Errand]:
    """Without end."""
    draw = Random(f"{seed}/errands")
    while True:
        sender, recipient = draw.sample(sorted(OFFICES), 2)
        priority = draw.choices(("high", "low", "normal"), (HIGH, LOW, 1 - HIGH - LOW))[0]
        later_s = draw.uniform(*LATER_S) if draw.random() < LATER else None
        yield Errand(sender, recipient, priority, later_s, draw.random() < ABSENT)
