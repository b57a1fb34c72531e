"""The door into the simulated world: a Unix socket for its owner only, one JSON object a line, each answered by one.

It exists in simulation alone: a demo or a test plays the people in the tunnel through it. A command waits until the
world comes to the gap between two steps, so it never meets half a step.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from robot.core.json_socket import JsonSocket
from robot.simulated.camera import SHOWN_FOR_S
from robot.simulated.errors import SimulatedWorldError, UnknownSwitch, WrongValue
from robot.simulated.faults import SWITCHES
from robot.simulated.obstacles import Person
from robot.simulated.robot import BUMP_S, SimulatedRobot
from robot.simulated.start import Pose

ANSWER_WITHIN_S = 5.0
Request = Mapping[str, Any]
Tell = Callable[[], dict[str, Any]]


@dataclass
class _Waiting:
    request: Any
    answer: SimpleQueue[dict[str, Any]] = field(default_factory=SimpleQueue)


class Door:
    """Listens in a thread of its own; `serve` answers in the thread that steps the world."""

    def __init__(
        self,
        robot: SimulatedRobot,
        path: Path,
        tell: Tell | None = None,
        answer_within_s: float = ANSWER_WITHIN_S,
    ) -> None:
        self._robot = robot
        self._tell = tell or dict
        self._answer_within_s = answer_within_s
        self._waiting: SimpleQueue[_Waiting] = SimpleQueue()
        # The client that plays the people may say nothing for hours.
        self._socket = JsonSocket(path, self._ask, silent_limit_s=None, name="door")
        robot.before_steps.append(self.serve)

    def serve(self) -> None:
        """Obey everything that waits."""
        while True:
            try:
                waiting = self._waiting.get_nowait()
            except Empty:
                return
            waiting.answer.put(obey(self._robot, waiting.request, self._tell))

    def _ask(self, request: Any) -> dict[str, Any]:
        waiting = _Waiting(request)
        self._waiting.put(waiting)
        try:
            return waiting.answer.get(timeout=self._answer_within_s)
        except Empty:
            return {
                "ok": False,
                "error": f"the world has not moved for {self._answer_within_s:g} s; is the robot running?",
            }

    def close(self) -> None:
        self._robot.before_steps.remove(self.serve)
        self._socket.close()


def obey(robot: SimulatedRobot, request: Any, tell: Tell = dict) -> dict[str, Any]:
    """One command's answer: `{"ok": true, …}`, or `{"ok": false, "error": sentence}`."""
    try:
        if not isinstance(request, dict):
            raise WrongValue("request", request, 'an object such as {"do": "state"}')
        name = request.get("do")
        if not isinstance(name, str) or name not in COMMANDS:
            raise UnknownSwitch("door command", name, COMMANDS)
        told = COMMANDS[name](robot, request)
        extra = tell() if name == "state" else {}
    except SimulatedWorldError as error:
        return {"ok": False, "error": str(error)}
    return {"ok": True, **told, **extra}


def _text(request: Request, name: str) -> str:
    value = request.get(name)
    if not isinstance(value, str) or not value:
        raise WrongValue(name, value, "a text")
    return value


def _flag(request: Request, name: str) -> bool:
    value = request.get(name)
    if not isinstance(value, bool):
        raise WrongValue(name, value, "true or false")
    return value


def _number(request: Request, name: str, low: float, high: float, default: float | None = None) -> float:
    value = request.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise WrongValue(name, value, f"a number from {low:g} to {high:g}")
    return float(value)


def _show_code(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.show_code(_text(request, "text"), _number(request, "for_s", 0, 3600, SHOWN_FOR_S))
    return {}


def _hide_code(robot: SimulatedRobot, _: Request) -> dict[str, Any]:
    robot.hide_code()
    return {}


def _battery(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.sag(_number(request, "ratio", 0, 1))
    return {}


def _bump(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.bump(_text(request, "side"), _number(request, "for_s", 0, 3600, BUMP_S))
    return {}


def _cliff(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.cliff(_flag(request, "on"))
    return {}


def _wheel_drop(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.lift(_flag(request, "on"))
    return {}


def _fault(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.set_fault(request.get("name"), request.get("value"))
    return {"faults": robot.faults.on()}


def _faults(_: SimulatedRobot, __: Request) -> dict[str, Any]:
    return {"switches": SWITCHES}


def _person(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    x_m, y_m = (_number(request, name, -1e5, 1e5) for name in ("x_m", "y_m"))
    robot.world.obstacles.append(Person(x_m, y_m, _number(request, "radius_m", 0.01, 5, 0.2)))
    return {}


def _clear_people(robot: SimulatedRobot, _: Request) -> dict[str, Any]:
    robot.world.obstacles[:] = [one for one in robot.world.obstacles if not isinstance(one, Person)]
    return {}


def _push(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.push(_number(request, "ahead_mm", -5000, 5000))
    return {}


def _place(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    x_m, y_m = (_number(request, name, -1e5, 1e5) for name in ("x_m", "y_m"))
    robot.place(Pose(x_m, y_m, _number(request, "heading_rad", -7, 7)))
    return {}


def _print_text(robot: SimulatedRobot, request: Request) -> dict[str, Any]:
    robot.print_text(_text(request, "text"))
    return {}


def _unplug(robot: SimulatedRobot, _: Request) -> dict[str, Any]:
    robot.unplug()
    return {}


def _plug_in(robot: SimulatedRobot, _: Request) -> dict[str, Any]:
    robot.plug_in()
    return {}


def _reset_base(robot: SimulatedRobot, _: Request) -> dict[str, Any]:
    robot.reset_base()
    return {}


def _state(robot: SimulatedRobot, _: Request) -> dict[str, Any]:
    return robot.state()


COMMANDS: dict[str, Callable[[SimulatedRobot, Request], dict[str, Any]]] = {
    "show_code": _show_code,  # {"text": …, "for_s"?: 20}
    "hide_code": _hide_code,
    "battery": _battery,  # {"ratio": 0…1}
    "bump": _bump,  # {"side": "left" | "right" | "both", "for_s"?: 0.5}
    "cliff": _cliff,  # {"on": true | false}
    "wheel_drop": _wheel_drop,  # {"on": true | false}
    "fault": _fault,  # {"name": one of SWITCHES, "value": …}
    "faults": _faults,
    "person": _person,  # {"x_m": …, "y_m": …, "radius_m"?: 0.2}
    "clear_people": _clear_people,
    "push": _push,  # {"ahead_mm": …}
    "place": _place,  # {"x_m": …, "y_m": …, "heading_rad": …}
    "print_text": _print_text,  # {"text": …}
    "unplug": _unplug,
    "plug_in": _plug_in,
    "reset_base": _reset_base,
    "state": _state,
}
