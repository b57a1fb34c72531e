"""Everything perception decides by, at one moment."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from robot.agent.perception.battery import BatterySense
from robot.mission.state import Held
from robot.skills.interfaces import View


@dataclass(frozen=True)
class MapPosition:
    """Where the robot is, in words of the map. Between posts `at` is None."""

    at: str | None = None
    """The bay, or the post itself where that has none."""
    previous: str | None = None
    destination: str | None = None
    way: str | None = None
    """forward, left, right, behind or arrived; None while it cannot be known."""
    rests_at: str | None = None
    """The post as long as the robot has not begun to roll on from there."""
    moved: str | None = None
    """The post where it found itself after it had been moved, until it has taken note."""
    astray: str | None = None
    """The post that it drives towards by mistake, until it has turned round."""
    doubted: str | None = None
    """The post just before which it was switched off, while it cannot tell whether it has passed it, or at which it was
    switched off in a turn, while it cannot tell which way it looks."""
    beside_dock: bool = False
    """It was switched off on its way into a dock or out of it, and stands beside the line."""
    closed: frozenset[str] = frozenset()
    """Corridors, by name, in which it turned back a short while ago."""
    detour: str | None = None
    """The neighbour to which the service sends it first."""
    bay_of: str | None = None
    """The post of the bay where it stands."""
    crossing: str | None = None
    """The post with bays that it is on its way across."""


@dataclass(frozen=True)
class Seen:
    """A moment. Ages are told by the parts' own times: nothing waits for another sensor."""

    at_s: float
    view: View = field(default_factory=View)
    battery: BatterySense = field(default_factory=BatterySense)
    where: MapPosition = MapPosition()
    held: Held = field(default_factory=Held)
    halting: frozenset[str] = field(default_factory=frozenset)
    """Those of the active faults that keep the wheels still until a person has seen to them."""
    home: str | None = None
    dockless: bool = False
    """There is no dock at its home."""
    dock_bays: Mapping[str, str] = field(default_factory=dict)
    """The bay with the dock, by post."""
    nearest_dock: str | None = None
    unsure: bool = False
    handing_over: bool = False
    watch: int = 0
