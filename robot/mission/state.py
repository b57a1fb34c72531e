"""The mission's state, read once and read again after a change."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from protocol.parts import Leg, MissionHeld, Position, Stop
from protocol.to_robot import Mission, Verifier
from robot.mission.loading import Loading

REVOKED: Final = "revoked"
"""The fault of a robot whose corridors were given to others; until it knows where it is."""


@dataclass(frozen=True)
class Held:
    """Everything that is remembered through a power cut, read once and read again after a change."""

    mission: Mission | None = None
    next_stop: int = 0
    cargo: tuple[str, ...] = ()
    grants: tuple[Leg, ...] = ()
    verifiers: tuple[Verifier, ...] = ()
    position: Position = field(default_factory=Position)
    paused: bool = False
    cancelled: frozenset[str] = frozenset()
    """Orders of the mission that are not to be served any more."""
    faults: frozenset[str] = frozenset()
    """Told and not over."""
    recharging: bool = False
    """The battery was low, and it is not full again yet."""
    loadings: Mapping[str, Loading] = field(default_factory=dict)
    """Where the mail aboard came from."""
    moment: str | None = None
    """What it is about that leaves doubt of its place after a power cut."""
    home: str | None = None
    """The bay that the service has given it to rest in."""
    detour: Leg | None = None
    """The corridor that it takes first: so that others can pass, or out of a hole in the network."""

    @property
    def revoked(self) -> bool:
        """Its corridors were given to others, and it does not know yet where it is."""
        return REVOKED in self.faults

    @property
    def stop(self) -> Stop | None:
        """The stop that comes next."""
        stops = self.mission.stops if self.mission else ()
        return stops[self.next_stop] if self.next_stop < len(stops) else None

    @property
    def mission_held(self) -> MissionHeld | None:
        if self.mission is None:
            return None
        return MissionHeld(id=self.mission.id, update=self.mission.update, next_stop=self.next_stop)
