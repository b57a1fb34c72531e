"""Corridors in which the robot turned back: no way leads through them for a while, not even after a restart."""

from collections.abc import Callable, Mapping
from typing import Final

from maps import CampusMap, UnknownCorridor, corridor_name
from protocol.parts import Leg
from protocol.to_robot import OpenWay

CLOSED_S: Final = 600.0
"""So long one counts as closed; then it is tried again."""


class Closed:
    """`ages_s`: the corridors as they were kept, by name, and how long ago it turned back in each. `keep` is given the
    same after every change."""

    def __init__(self, ages_s: Mapping[str, float], keep: Callable[[Mapping[str, float]], None], now: float) -> None:
        self._since_s = {name: now - age_s for name, age_s in ages_s.items()}
        self._told = frozenset(ages_s)
        self._keep = keep
        self.pass_time(now)

    @property
    def names(self) -> frozenset[str]:
        return frozenset(self._since_s)

    @property
    def over(self) -> frozenset[str]:
        """Those that are open again, of which people have not been told yet."""
        return self._told - self.names

    def note_told(self) -> None:
        """People know how it is now."""
        self._told = self.names

    def pass_time(self, now: float) -> None:
        """Those whose time is over are open."""
        self._now_s = now
        self._since_s = {name: since_s for name, since_s in self._since_s.items() if now - since_s < CLOSED_S}

    def age_s(self, name: str) -> float | None:
        """Return the time since it turned back in there; None where it is open."""
        return self._now_s - self._since_s[name] if name in self._since_s else None

    def close(self, leg: Leg, now: float) -> None:
        """It has turned back in this corridor."""
        name = corridor_name(leg.from_post, leg.to_post)
        self._since_s[name] = self._now_s = now
        self._told |= {name}
        self._keep_all()

    def open(self, name: str) -> None:
        """A person has looked. Told to be over even if it was open: the person who reports it believed it to be
        closed."""
        self._since_s.pop(name, None)
        self._told |= {name}
        self._keep_all()

    def open_all(self) -> None:
        """It has waited: the person or thing that stood there may have gone."""
        self._since_s = {}
        self._keep({})

    def _keep_all(self) -> None:
        self._keep({name: self._now_s - since_s for name, since_s in self._since_s.items()})


def open_way(campus: CampusMap, closed: Closed, wish: OpenWay, looked_s_ago: float) -> str | None:
    """Open a corridor on a person's report; return why not, or None."""
    name = corridor_name(*wish.ends)
    try:
        campus.corridor_named(name)
    except UnknownCorridor:
        return f"There is no corridor between {wish.ends[0]} and {wish.ends[1]} on this robot's map."
    turned_back_s_ago = closed.age_s(name)
    if turned_back_s_ago is not None and turned_back_s_ago < looked_s_ago:
        return f"The robot has turned back between {wish.ends[0]} and {wish.ends[1]} again since."
    closed.open(name)
    return None
