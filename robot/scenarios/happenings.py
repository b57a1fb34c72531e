"""Events at a moment: faults, deeds of people, messages of the service. Each once, for each robot it concerns."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Final

from maps import CampusMap
from protocol.parts import Part
from protocol.to_robot import Cancel, EmergencyStop, Pause, Recall, Resume
from robot.scenarios.actors.actors import Actor
from robot.scenarios.actors.stand_in import StandIn
from robot.scenarios.scenario import Deed, FaultRow, MessageRow, Scenario, Timed
from robot.simulated import Faults
from robot.simulated.start import start_pose

Note = Callable[[str, str], None]
"""Told what has happened, for the record: to which robot, and what."""


@dataclass
class Happenings:
    """`tick` does everything that is due."""

    campus: CampusMap
    service: StandIn
    note: Note
    pending: list[tuple[Timed, Actor]] = field(default_factory=list)
    _over: list[tuple[float, Actor, FaultRow]] = field(default_factory=list)

    def add(self, scenario: Scenario, actors: Iterable[Actor]) -> None:
        """Everything in the scenario, for every robot it concerns."""
        rows: tuple[Timed, ...] = (*scenario.fault, *scenario.deed, *scenario.message)
        self.pending += [(row, one) for one in actors for row in rows if row.robot in (None, one.name)]

    def tick(self, now: float) -> None:
        due = [one for one in self.pending if _is_due(*one, now)]
        self.pending = [one for one in self.pending if one not in due]
        for row, actor in due:
            self._happen(row, actor, now)
        for end in [one for one in self._over if now >= one[0]]:
            self._over.remove(end)
            end[1].body.set_fault(end[2].switch, getattr(Faults, end[2].switch))
            self.note(end[1].name, f"{end[2].switch} is over")

    def _happen(self, row: Timed, actor: Actor, now: float) -> None:
        match row:
            case FaultRow():
                actor.body.set_fault(row.switch, row.value)
                self.note(actor.name, f"{row.switch} = {row.value}")
                if row.for_s is not None:
                    self._over.append((now + row.for_s, actor, row))
            case Deed():
                _DEEDS[row.do](actor, row, self.campus)
                self.note(actor.name, f"a person: {row.do.replace('_', ' ')}{f' to {row.to}' if row.to else ''}")
            case MessageRow():
                self._say(actor.name, row)
                self.note(actor.name, f"service: {row.say}{f' {row.order}' if row.order else ''}")

    def _say(self, robot: str, row: MessageRow) -> None:
        service = self.service
        command_id = service.command_id(robot, f"{row.say} {row.order}" if row.order else row.say)
        if row.say == "cancel":
            service.letters[row.order or ""].cancelled = True
        if row.say == "recall":
            for letter in service.letters.values():
                letter.recalled = letter.recalled or letter.robot == robot
                letter.returning = letter.returning or letter.place == robot
        service.push(robot, _message(row, command_id))


def _is_due(row: Timed, actor: Actor, now: float) -> bool:
    if row.after_post is None:
        return now >= row.at_s
    seen_s = next((at_s for at_s, post in actor.posts if post == row.after_post), None)
    return seen_s is not None and now >= seen_s + row.at_s


def _message(row: MessageRow, command_id: str) -> Part:
    match row.say:
        case "cancel":
            return Cancel(command_id=command_id, order_id=row.order or "")
        case "pause":
            return Pause(command_id=command_id, reason="as the scenario says")
        case "resume":
            return Resume(command_id=command_id)
        case "recall":
            return Recall(command_id=command_id, reason="as the scenario says")
    return EmergencyStop(command_id=command_id, reason="as the scenario says")


def _carry(actor: Actor, row: Deed, campus: CampusMap) -> None:
    """Picked up, put down elsewhere."""
    actor.carry(start_pose(campus, row.to or "dock"))


_DEEDS: Final[dict[str, Callable[[Actor, Deed, CampusMap], None]]] = {
    "bump": lambda actor, row, _: actor.body.bump("both", row.for_s),
    "lift": lambda actor, _, __: actor.body.lift(True),
    "put_down": lambda actor, _, __: actor.body.lift(False),
    "carry": _carry,
    "push": lambda actor, row, _: actor.body.push(row.ahead_mm),
    "sag": lambda actor, row, _: actor.body.sag(row.ratio),
    "spot": lambda actor, _, __: actor.body.press("spot"),
    "clean": lambda actor, _, __: actor.body.press("clean"),
    "show_code": lambda actor, row, _: actor.body.show_code(row.text, row.for_s),
    "unplug": lambda actor, _, __: actor.body.unplug(),
    "plug_in": lambda actor, _, __: actor.body.plug_in(),
    "reset_base": lambda actor, _, __: actor.body.reset_base(),
    "stop": lambda actor, _, __: actor.parts.mind.hands.body.emergency_stop(),
}
