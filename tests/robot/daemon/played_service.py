"""A service in memory that a test plays for a simulated robot: it grants what is claimed, unless it lets it wait."""

from dataclasses import dataclass, field

from protocol.parts import Leg, Part
from protocol.to_robot import Grant, Mission
from protocol.to_server import Claim, Clear, Withdraw
from robot.mission.memory import Incoming
from robot.mission.mission import MissionManager


@dataclass
class PlayedService:
    """`held` are the corridors that it believes to be the robot's, `unanswered` the claims that it lets wait."""

    missions: MissionManager
    online: bool = True
    lets_wait: bool = False
    held: list[Leg] = field(default_factory=list)
    unanswered: list[Claim] = field(default_factory=list)
    _waiting: list[Incoming] = field(default_factory=list)
    _heard: int = 0
    _said: int = 0

    def says(self, message: Part) -> None:
        self._said += 1
        if isinstance(message, Mission):
            self.missions.memory.hold(message)
        if isinstance(message, Grant):
            self.missions.memory.grant(message.legs)
        self._waiting.append(Incoming(message, "service", self._said))

    def incoming(self) -> list[Incoming]:
        """Called in every tick of the mind: that is when the robot is heard, too."""
        if not self.online:
            return []
        for kept in self.missions.outbox.pending(after=self._heard, limit=1000):
            self._heard = kept.seq
            self._hear(kept.message)
        taken, self._waiting = self._waiting, []
        return taken

    def _hear(self, message: Part) -> None:
        match message:
            case Claim() if self.lets_wait:
                self.unanswered = [message]
            case Claim():
                self.grant(message)
            case Withdraw():
                self.unanswered = [claim for claim in self.unanswered if claim.claim_id != message.claim_id]
            case Clear():
                self.held.remove(message.leg)

    def grant(self, claim: Claim) -> None:
        self.held += [leg for leg in claim.legs if leg not in self.held]
        self.says(Grant(claim_id=claim.claim_id, legs=claim.legs))

    def wake(self) -> None:
        pass
