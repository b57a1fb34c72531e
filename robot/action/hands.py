"""What actions work with."""

from collections.abc import Callable
from dataclasses import dataclass, field

from protocol.to_server import Step

from ..drivers.interfaces import BodyShape
from ..duties import Duties
from ..navigator import Navigator
from ..skills.interfaces import Body, View


@dataclass
class Hands:
    """The body, the map in the robot's head, and its duties. `view` is what the mind's present tick goes by."""

    body: Body
    navigator: Navigator
    duties: Duties
    cruise_mm_s: float = 120.0
    turn_mm_s: float = 80.0
    shape: BodyShape = field(default_factory=BodyShape)
    view: View = field(default_factory=View)
    noted: Callable[[str], None] = lambda _: None
    """Told what is worth a line for the person who watches."""

    @property
    def place(self) -> str | None:
        """The post to name in a report: where the robot stands, or the last one it has seen."""
        return self.navigator.here

    def report(self, step: Step, stop_id: str, reason: str | None = None) -> None:
        self.duties.report(step, stop_id, self.place, reason)
