"""Real daemons, each a process with its robot on a pseudo-terminal, in one simulated world."""

import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from protocol.clock import SharedClock
from robot.core.json_socket import ask
from robot.simulated import CollisionJudge, WorldFile

ROOT = Path(__file__).parents[3]
SPEED = 4.0
TOUCH_MM = 5.0


class Daemons:
    """Daemons on the test track, with one clock, one world and a judge who looks at it."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.judge = folder, CollisionJudge()
        SharedClock.create(folder / "clock", SPEED)
        self.world = WorldFile.create(folder / "world")
        self.running: dict[str, subprocess.Popen[str]] = {}

    def command(self, name: str, *more: str) -> list[str]:
        options = ("--world", str(self.folder / "world"), "--clock", str(self.folder / "clock"), "--name", name)
        own = ("--data", str(self.folder / name), "--door", str(self.folder / f"{name}.door"))
        return [sys.executable, "-m", "robot", "--simulated", *options, *own, *more]

    def start(self, name: str, *more: str) -> None:
        log = (self.folder / f"{name}.log").open("a")
        with log:
            self.running[name] = subprocess.Popen(self.command(name, *more), cwd=ROOT, stderr=log, text=True)

    def kill(self, name: str) -> None:
        self.running[name].kill()
        self.running[name].wait()

    def until(self, what: str, holds: Callable[[], object], limit_s: float = 100.0) -> None:
        until_s = time.monotonic() + limit_s
        while not holds():
            assert time.monotonic() < until_s, f"not within {limit_s:.0f} s: {what}; {self.world.poses()}"
            self.judge.look(self.world.poses())
            time.sleep(0.01)

    def do(self, name: str, **request: object) -> None:
        assert ask(self.folder / f"{name}.door", request)["ok"]

    def close(self) -> None:
        for process in self.running.values():
            process.kill()
            process.wait()
        self.world.close()


@pytest.fixture
def daemons() -> Iterator[Daemons]:
    with TemporaryDirectory(prefix="cm-") as folder:  # sockets have short paths
        made = Daemons(Path(folder))
        yield made
        made.close()


@pytest.mark.slow
@pytest.mark.system
@pytest.mark.timeout(300)
def test_daemons_meet_on_the_line_and_one_that_was_killed_stands_there_until_it_is_started_again(
    daemons: Daemons,
) -> None:
    daemons.start("r2", "--start", "post2:post1")
    daemons.until("r2 is in the world", lambda: "r2" in daemons.world.poses())
    daemons.do("r2", do="place", x_m=0.0, y_m=3.2, heading_rad=-1.5708)
    daemons.until("it stands on the line", lambda: daemons.world.poses()["r2"].handled == 1)
    daemons.kill("r2")
    stood = daemons.world.poses()["r2"]

    daemons.start("r1", "--start", "post1:post2", "--achieve", "visit(post2)")
    daemons.until("r1 has run into r2", lambda: daemons.judge.found)
    (met, *_) = daemons.judge.found
    assert (met.one, met.other) == ("r1", "r2")
    assert max(one.depth_mm for one in daemons.judge.found) < TOUCH_MM
    assert daemons.world.poses()["r2"] == stood, "it stands where it stood"

    daemons.start("r2", "--start", "dock")
    daemons.until("r2 lives again", lambda: daemons.world.poses()["r2"].time_s > stood.time_s)
    again = daemons.world.poses()["r2"]
    assert (again.x_m, again.y_m, again.handled) == pytest.approx((stood.x_m, stood.y_m, stood.handled), abs=0.001)
    daemons.do("r2", do="place", x_m=2.0, y_m=1.0, heading_rad=0.0)
    daemons.until("r1 goes on", lambda: daemons.world.poses()["r1"].y_m < 3.0)


@pytest.mark.slow
@pytest.mark.system
def test_a_second_daemon_of_a_robot_that_is_in_the_world_is_refused(daemons: Daemons) -> None:
    daemons.start("r1")
    daemons.until("r1 is in the world", lambda: "r1" in daemons.world.poses())
    command = [*daemons.command("r1"), "--data", str(daemons.folder / "another"), "--door", str(daemons.folder / "d")]
    refused = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert refused.returncode == 2
    assert re.search(
        r"r1 is in the world .* already, and its process runs\. Stop that one, or .* --name", refused.stderr
    )
