"""The control socket: over a real socket, with a drive loop that runs, and with visitors who mean no good."""

import json
import socket
import stat
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from protocol.clock import RealClock
from robot.core.config import load_settings
from robot.core.json_socket import LONGEST_LINE, MAX_VISITORS, JsonSocket, NoAnswer, ask
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.control import SOCKET_NAME, Control
from robot.ops.runners import Loop, ThreadedRunner
from robot.ops.status import StatusBoard
from robot.skills.interfaces import View


class Running:
    """A simulated robot on threads, with its control socket."""

    def __init__(self, data: Path) -> None:
        clock = RealClock()
        self.parts: Parts = assemble(load_settings(None, {"data": data}), clock, Simulation("post3:post2"))
        self.gate = threading.Event()
        self.gate.set()
        self.runner = ThreadedRunner([self._gated(loop) for loop in self.parts.daemon.loops()], clock)
        board = StatusBoard("r1", self.parts.daemon, self.parts.mind, self.runner, clock, clock.now())
        self.path = data / SOCKET_NAME
        self.socket = JsonSocket(self.path, Control(self.parts.daemon.drive, board.tell).answer)
        self._thread = threading.Thread(target=self.runner.run)
        self._thread.start()
        self.until(lambda: self.parts.daemon.drive.view.base)

    def _gated(self, loop: Loop) -> Loop:
        """The mind hangs while the gate is shut."""
        if loop.name != "mind":
            return loop

        def tick(now: float) -> None:
            self.gate.wait()
            loop.tick(now)

        return replace(loop, tick=tick)

    def until(self, wanted: Callable[[], Any], limit_s: float = 15.0) -> None:
        until_s = time.monotonic() + limit_s
        while not wanted():
            assert time.monotonic() < until_s, ask(self.path, {"do": "status"})
            time.sleep(0.02)

    def close(self) -> None:
        self.socket.close()
        self.runner.stop()
        self._thread.join()
        self.parts.daemon.close(RealClock().now())


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    running = Running(tmp_path_factory.mktemp("robot"))
    yield running
    running.close()


def test_status_tells_what_the_robot_does_its_battery_and_how_punctual_it_is(running: Running) -> None:
    running.until(lambda: running.runner.lags["mind"].ticks > 5)
    told = ask(running.path, {"do": "status"})
    assert told["ok"]
    assert told["base"]["mode"] in {"passive", "safe"}
    assert told["base"]["frames"] > 0
    assert 0 < told["battery"]["ratio"] <= 1
    assert set(told["loops"]) == {"world", "line and drive", "camera", "mind", "tell", "host"}
    mind = told["loops"]["mind"]
    assert 0 <= mind["late_p50_ms"] <= mind["late_p99_ms"] <= mind["late_worst_ms"]


def test_a_stop_is_answered_when_the_wheels_stand_and_holds_until_somebody_rearms(running: Running) -> None:
    answer = ask(running.path, {"do": "stop"})
    assert (answer["ok"], "emergency_stop" in answer["faults"]) == (True, True)
    assert ask(running.path, {"do": "status"})["faults"].keys() >= {"emergency_stop"}
    assert ask(running.path, {"do": "rearm"})["ok"]
    assert "emergency_stop" not in ask(running.path, {"do": "status"})["faults"]


def test_a_robot_whose_mind_hangs_can_still_be_asked_and_stopped(running: Running) -> None:
    running.gate.clear()
    try:
        running.until(lambda: "agent_silent" in ask(running.path, {"do": "status"}).get("faults", {}))
        assert ask(running.path, {"do": "stop"})["ok"]
    finally:
        running.gate.set()
    running.until(lambda: ask(running.path, {"do": "rearm"})["ok"])


def test_the_black_box_is_written_on_demand(tmp_path: Path) -> None:
    control = Control(StandingDrive(), dict, lambda: tmp_path / "box.jsonl.gz")
    assert control.answer({"do": "black_box"}) == {"ok": True, "file": str(tmp_path / "box.jsonl.gz")}
    assert Control(StandingDrive(), dict).answer({"do": "black_box"})["ok"] is False


def test_a_stop_that_the_drive_loop_does_not_obey_is_not_called_done() -> None:
    answer = Control(StandingDrive(), dict).answer({"do": "stop"})
    assert (answer["ok"], "not within" in answer["error"]) == (False, True)


class StandingDrive:
    """A drive loop that does not run: nothing that is asked of it happens."""

    view = View(at_s=0.0)

    def emergency_stop(self) -> None: ...

    def rearm(self) -> None: ...


def test_a_robot_in_the_air_is_not_rearmed_and_says_why(running: Running) -> None:
    assert running.parts.robot
    running.parts.robot.lift(True)
    running.until(lambda: "wheel_drop" in running.parts.daemon.drive.view.faults)
    answer = ask(running.path, {"do": "rearm"})
    running.parts.robot.lift(False)
    assert (answer["ok"], "wheel_drop" in answer["error"]) == (False, True)
    running.until(lambda: ask(running.path, {"do": "rearm"})["ok"])


def test_only_its_owner_may_speak_to_it(running: Running) -> None:
    assert stat.S_IMODE(running.path.stat().st_mode) == 0o600
    assert stat.S_ISSOCK(running.path.stat().st_mode)


@pytest.mark.parametrize(
    "line",
    [
        b"stop\n",
        b"[1, 2]\n",
        b"{}\n",
        b'{"do": ["stop"]}\n',
        b'{"do": "dance"}\n',
        b"\xff\xfe\x00\n",
        b"[" * 3000 + b"\n",
        b'{"do": null}\n',
        b"\n",
    ],
)
def test_nonsense_is_answered_in_words_and_the_next_request_is_heard(running: Running, line: bytes) -> None:
    with socket.socket(socket.AF_UNIX) as visitor, visitor.makefile("rb") as answers:
        visitor.connect(str(running.path))
        visitor.sendall(line)
        answer = json.loads(answers.readline())
        assert answer["ok"] is False
        assert answer["error"]
        visitor.sendall(b'{"do": "status"}\n')
        assert json.loads(answers.readline())["ok"]


def test_a_line_without_end_is_cut_off(running: Running) -> None:
    with socket.socket(socket.AF_UNIX) as visitor:
        visitor.connect(str(running.path))
        visitor.settimeout(3)
        visitor.sendall(b"x" * (LONGEST_LINE + 1))
        with visitor.makefile("rb") as answers:
            assert "at most" in json.loads(answers.readline())["error"]
            assert answers.readline() == b""


def test_a_crowd_that_says_nothing_keeps_nobody_out_for_long(tmp_path: Path) -> None:
    quiet = JsonSocket(tmp_path / "control", lambda _: {"ok": True}, silent_limit_s=0.2)
    crowd = [socket.socket(socket.AF_UNIX) for _ in range(MAX_VISITORS + 3)]
    for one in crowd:
        one.settimeout(3)  # one that may not wait is refused at once where no more can queue
        one.connect(str(tmp_path / "control"))
    time.sleep(0.6)
    assert ask(tmp_path / "control", {"do": "status"}) == {"ok": True}
    for one in crowd:
        one.close()
    quiet.close()
    assert not (tmp_path / "control").exists()


def test_a_mistake_of_ours_is_told_and_ends_nothing(tmp_path: Path) -> None:
    def broken(request: Any) -> dict[str, Any]:
        if request == {"do": "break"}:
            raise KeyError("mind")
        return {"ok": True}

    door = JsonSocket(tmp_path / "control", broken)
    assert ask(tmp_path / "control", {"do": "break"}) == {"ok": False, "error": "KeyError('mind')"}
    assert ask(tmp_path / "control", {"do": "status"}) == {"ok": True}
    door.close()


def test_a_path_longer_than_an_address_of_a_socket_works_too(tmp_path: Path) -> None:
    folder = tmp_path / ("long" * 30)
    folder.mkdir()
    door = JsonSocket(folder / "control", lambda _: {"ok": True})
    assert ask(folder / "control", {}) == {"ok": True}
    door.close()


def test_nobody_at_home_is_told(tmp_path: Path) -> None:
    with pytest.raises(NoAnswer, match="No robot answers"):
        ask(tmp_path / "control", {"do": "status"})
