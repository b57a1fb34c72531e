"""Durations of corridors, stops and waits, as they have lately been, each beside what is assumed from map and settings.

Learned are *ratios*: seen seconds over assumed ones. So what one corridor teaches (the robots are slower than the map
says) holds for another that no robot has driven yet.

Of each thing the latest ratios are kept as they are. Of the usual small algorithms P² never forgets, and a running mean
of quantiles cannot be drawn from; a plan is simulated by draws, and fifty numbers are little.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import accumulate
from random import Random
from typing import Final, NamedTuple

KEPT: Final = 50
"""Latest ratios of one thing: what has changed is known after so many."""
POOLED: Final = 300
"""Latest ratios of all things of one kind."""
WEIGHT_OF_KIND: Final = 4.0
"""What the kind says counts as much as so many ratios of the thing itself."""
LONGEST_S: Final = 4 * 3600.0
"""What takes longer tells of a fault, not of how long things take."""
SHORTEST_ASSUMED_S: Final = 1.0


class Kind(StrEnum):
    """Kinds of durations."""

    CORRIDOR = "corridor"
    LOAD = "load"
    RECEIVE = "receive"
    FETCH = "fetch"
    """From an order to the robot at its sender's."""


ASSUMED: Final[dict[Kind, tuple[float, ...]]] = {
    Kind.CORRIDOR: (0.8, 0.9, 1.0, 1.15, 1.5),
    Kind.LOAD: (0.25, 0.5, 0.8, 1.2, 2.0),
    Kind.RECEIVE: (0.25, 0.5, 0.8, 1.2, 2.0),
    Kind.FETCH: (0.3, 0.6, 1.0, 1.5, 2.5),
}
"""Ratios before anything was seen: assumed, wide on purpose, and the first to be forgotten."""


class Thing(NamedTuple):
    """One thing that takes time: a corridor in one direction, a kind of stop at its hours, a length of the queue."""

    kind: Kind
    name: str
    assumed_s: float


@dataclass
class Durations:
    """The latest observations. `version` grows with each one."""

    version: int = 0
    _of_thing: dict[tuple[Kind, str], deque[float]] = field(default_factory=dict)
    _of_kind: dict[Kind, deque[float]] = field(
        default_factory=lambda: {kind: deque(ratios, POOLED) for kind, ratios in ASSUMED.items()}
    )
    _seen: dict[Kind, int] = field(default_factory=lambda: dict.fromkeys(Kind, 0))

    def observe(self, thing: Thing, seconds: float) -> bool:
        """Learn from one; whether it was anything to learn from."""
        if not self.is_plausible(seconds):
            return False
        ratio = seconds / max(thing.assumed_s, SHORTEST_ASSUMED_S)
        self._of_thing.setdefault((thing.kind, thing.name), deque(maxlen=KEPT)).append(ratio)
        kind = self._of_kind[thing.kind]
        if self._seen[thing.kind] < len(ASSUMED[thing.kind]):
            kind.popleft()
        kind.append(ratio)
        self._seen[thing.kind] += 1
        self.version += 1
        return True

    @staticmethod
    def is_plausible(seconds: float) -> bool:
        """Tell if it can be a duration: no clock was set, nothing lay there over night."""
        return 0.0 <= seconds <= LONGEST_S

    def seen(self, kind: Kind, name: str | None = None) -> int:
        """Count the observations of a thing, as far as they are remembered; or of anything of its kind."""
        return self._seen[kind] if name is None else len(self._of_thing.get((kind, name), ()))

    def draw_s(self, thing: Thing, rng: Random, over_s: float = 0.0) -> float:
        """As long as it may take, the next time. `over_s`: it has taken so long already, and is not over."""
        return self.draws_s(thing, rng, 1, over_s)[0]

    def draws_s(self, thing: Thing, rng: Random, count: int, over_s: float = 0.0) -> list[float]:
        """So many such draws, independent of each other."""
        draw = self._drawer(thing, rng)
        return [_longer_than(over_s, draw) for _ in range(count)] if over_s else [draw() for _ in range(count)]

    def _drawer(self, thing: Thing, rng: Random) -> Callable[[], float]:
        own, kind = self._of_thing.get((thing.kind, thing.name), ()), self._of_kind[thing.kind]
        assumed_s = max(thing.assumed_s, SHORTEST_ASSUMED_S)

        def draw() -> float:
            place = rng.random() * (len(own) + WEIGHT_OF_KIND)
            ratio = own[int(place)] if place < len(own) else kind[int(rng.random() * len(kind))]
            return ratio * assumed_s

        return draw

    def quantile_s(self, thing: Thing, share: float) -> float:
        """So long at most, in so large a share of cases."""
        own, kind = self._of_thing.get((thing.kind, thing.name), ()), self._of_kind[thing.kind]
        each = WEIGHT_OF_KIND / len(kind)
        weighted = sorted([(ratio, 1.0) for ratio in own] + [(ratio, each) for ratio in kind])
        wanted = share * (len(own) + WEIGHT_OF_KIND)
        sums = accumulate(weight for _, weight in weighted)
        ratio = next(
            (ratio for (ratio, _), total in zip(weighted, sums, strict=True) if total >= wanted), weighted[-1][0]
        )
        return ratio * max(thing.assumed_s, SHORTEST_ASSUMED_S)


TRIES: Final = 20
LONGER: Final = 1.2
"""What has taken longer than all that was ever seen takes this much longer still."""


def _longer_than(over_s: float, draw: Callable[[], float]) -> float:
    for _ in range(TRIES):
        drawn_s = draw()
        if drawn_s > over_s:
            return drawn_s
    return max(drawn_s, over_s * LONGER)
