"""A service in memory that a test plays for a simulated robot: it grants what is claimed, unless it is told not to."""

from dataclasses import dataclass, field

from protocol.parts import Leg, Part
from protocol.to_robot import Grant, Mission
from protocol.to_server import Claim, Clear
from robot.duties import Duties
from robot.memory import Incoming


@dataclass
class PlayedService:
    """`held` are the corridors that it believes to be the robot's."""

    duties: Duties
    online: bool = True
    held: list[Leg] = field(default_factory=list)
    _waiting: list[Incoming] = field(default_factory=list)
    _heard: int = 0
    _said: int = 0

    def says(self, message: Part) -> None:
        self._said += 1
        if isinstance(message, Mission):
            self.duties.memory.hold(message)
        if isinstance(message, Grant):
            self.duties.memory.grant(message.legs)
        self._waiting.append(Incoming(message, "service", self._said))

    def incoming(self) -> list[Incoming]:
        """Called in every tick of the mind: that is when the robot is heard, too."""
        if not self.online:
            return []
        for kept in self.duties.outbox.pending(after=self._heard, limit=1000):
            self._heard = kept.seq
            self._hear(kept.message)
        taken, self._waiting = self._waiting, []
        return taken

    def _hear(self, message: Part) -> None:
        if isinstance(message, Claim):
            self.held += [leg for leg in message.legs if leg not in self.held]
            self.says(Grant(claim_id=message.claim_id, legs=message.legs))
        if isinstance(message, Clear):
            self.held.remove(message.leg)

    def wake(self) -> None:
        pass
