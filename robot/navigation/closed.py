"""Corridors in which the robot turned back: no way leads through them for a while, not even after a restart."""

from collections.abc import Callable, Mapping
from typing import Final

from maps import corridor_name
from protocol.parts import Leg

CLOSED_S: Final = 600.0
"""So long one counts as closed; then it is tried again."""


class Closed:
    """`ages_s`: the corridors as they were kept, by name, and how long ago it turned back in each. `keep` is given the
    same after every change."""

    def __init__(self, ages_s: Mapping[str, float], keep: Callable[[Mapping[str, float]], None], now: float) -> None:
        self._since_s = {name: now - age_s for name, age_s in ages_s.items()}
        self._keep = keep
        self.pass_time(now)

    @property
    def names(self) -> frozenset[str]:
        return frozenset(self._since_s)

    def pass_time(self, now: float) -> None:
        """Those whose time is over are open."""
        self._since_s = {name: since_s for name, since_s in self._since_s.items() if now - since_s < CLOSED_S}

    def close(self, leg: Leg, now: float) -> None:
        """It has turned back in this corridor."""
        self._since_s[corridor_name(leg.from_post, leg.to_post)] = now
        self._keep({name: now - since_s for name, since_s in self._since_s.items()})

    def open_all(self) -> None:
        """It has waited: whoever stood there may have gone."""
        self._since_s = {}
        self._keep({})
