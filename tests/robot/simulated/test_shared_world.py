"""One world for several processes: a row in a file for each body, which outlives its process."""

import math
import subprocess
import sys
from multiprocessing import get_context
from pathlib import Path

import pytest

from robot.simulated import CollisionJudge, Pose, SharedWorld, SimulatedRobot, SimulatedWorldError, TruePose, WorldFile
from tests.plain_maps import plain_map
from tests.robot.simulated.conftest import EXACT, Bench

ROOT = Path(__file__).parents[3]
TRACK = plain_map("test_track")
STEP_S = 0.005


class Robots:
    """Robots that live in one file, each with a `SharedWorld` of its own as if it were another process."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._open: list[tuple[SimulatedRobot, SharedWorld]] = []

    def add(self, name: str, y_m: float, heading_rad: float) -> Bench:
        world = SharedWorld(TRACK, self.path, name)
        robot = SimulatedRobot(TRACK, 0.0, "post1:post2", in_memory=True, options=EXACT, world=world)
        self._open.append((robot, world))
        robot.body.place(0.0, y_m, heading_rad)
        bench = Bench(robot)
        bench.send(128, 131)
        return bench

    def close(self) -> None:
        for robot, world in self._open:
            robot.close()
            world.close()


@pytest.fixture
def robots(tmp_path: Path):
    made = Robots(tmp_path / "world")
    yield made
    made.close()


def judged(path: Path, benches: list[Bench], seconds: float) -> CollisionJudge:
    judge, world = CollisionJudge(), WorldFile(path)
    for _ in range(round(seconds / STEP_S)):
        for bench in benches:
            bench.run(STEP_S)
        judge.look(world.poses())
    world.close()
    return judge


def test_robots_of_two_processes_run_into_each_other_and_do_not_overlap(robots: Robots) -> None:
    one, other = robots.add("r1", 3.0, math.pi / 2), robots.add("r2", 4.0, -math.pi / 2)
    one.drive(200, 200)
    other.drive(200, 200)
    judge = judged(robots.path, [one, other], 4.0)
    assert (judge.touches, judge.overlaps) == (1, [])
    assert (one.ask(7), other.ask(7)) == (0b11, 0b11)


def test_ghosts_pass_through_each_other_and_the_judge_sees_it(robots: Robots) -> None:
    WorldFile.create(robots.path, ghosts=True).close()
    one, other = robots.add("r1", 3.0, math.pi / 2), robots.add("r2", 4.0, -math.pi / 2)
    one.drive(200, 200)
    other.drive(200, 200)
    judge = judged(robots.path, [one, other], 4.0)
    (overlap,) = judge.overlaps
    assert overlap.depth_mm == pytest.approx(348.5, abs=3)
    assert one.robot.pose.y_m > other.robot.pose.y_m + 0.4


def test_one_whose_process_has_ended_stands_where_it_stood_and_goes_on_from_there(robots: Robots) -> None:
    left = robots.add("r2", 4.0, -math.pi / 2)
    left.robot.push(-40)
    left.run(0.1)
    stood = left.robot.pose
    robots.close()
    robots._open.clear()
    one = robots.add("r1", 3.0, math.pi / 2)
    one.drive(200, 200)
    judged(robots.path, [one], 6.0)
    assert one.ask(7) == 0b11
    again = SharedWorld(TRACK, robots.path, "r2")
    assert again.left == Pose(stood.x_m, stood.y_m, stood.heading_rad)
    again.close()


def test_a_person_who_carried_a_robot_is_remembered_by_the_next_process(robots: Robots) -> None:
    robots.add("r1", 3.0, 0.0).robot.push(10)
    robots._open[0][0].step_until(1.0)
    robots.close()
    robots._open.clear()
    again = robots.add("r1", 3.0, 0.0)
    again.run(0.1)
    world = WorldFile(robots.path)
    assert world.poses()["r1"].handled == 1, "a new start of the daemon is no hand"
    world.close()


def test_a_file_that_is_something_else_is_named_and_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "letter"
    path.write_text("Dear Ada,")
    with pytest.raises(SimulatedWorldError, match=r"letter: robots cannot share a world there.*--world"):
        WorldFile(path)
    with pytest.raises(SimulatedWorldError, match="No such file or directory"):
        WorldFile(tmp_path / "nowhere" / "world")
    assert path.read_text() == "Dear Ada,"


def test_a_full_world_is_named(tmp_path: Path) -> None:
    world = WorldFile(tmp_path / "world")
    for number in range(64):
        world.write(world.take(f"r{number}"), TruePose(0.0, float(number), 0.0, 0.0))
    assert len(world.poses()) == 64
    with pytest.raises(SimulatedWorldError, match="room for 64 robots"):
        world.take("one_more")
    world.close()


def test_a_pose_whose_writer_was_killed_in_the_middle_is_the_one_before(tmp_path: Path) -> None:
    """The number of the newest pose is written last: without that the new one does not count."""
    world = WorldFile(tmp_path / "world")
    row = world.take("r1")
    world.write(row, TruePose(1.0, 1.0, 1.0, 1.0, 1))
    before = (tmp_path / "world").read_bytes()
    world.write(row, TruePose(2.0, 2.0, 2.0, 2.0, 2))
    after = (tmp_path / "world").read_bytes()
    world.close()
    changed = [at for at, (old, new) in enumerate(zip(before, after, strict=True)) if old != new]
    number_at = min(changed)
    (tmp_path / "world").write_bytes(after[:number_at] + before[number_at : number_at + 8] + after[number_at + 8 :])
    world = WorldFile(tmp_path / "world")
    assert world.poses() == {"r1": TruePose(1.0, 1.0, 1.0, 1.0, 1)}
    world.close()


def write_for_ever(path: str) -> None:
    world = WorldFile(Path(path))
    row, value = world.take("r1"), 0
    while True:
        value += 1
        world.write(row, TruePose(value, value, value, value, value))


@pytest.mark.slow
def test_no_reader_ever_sees_half_a_pose_of_a_process_that_writes_as_fast_as_it_can(tmp_path: Path) -> None:
    world = WorldFile(tmp_path / "world")
    writer = get_context("spawn").Process(target=write_for_ever, args=(str(tmp_path / "world"),), daemon=True)
    writer.start()
    while not world.poses():
        assert writer.is_alive()
    seen = set()
    while len(seen) < 20_000:
        pose = world.read(0)
        assert pose is not None
        assert pose.time_s == pose.x_m == pose.y_m == pose.heading_rad == pose.handled
        seen.add(pose.handled)
    writer.kill()
    writer.join()
    world.close()


TAKE = "import sys; from pathlib import Path; from robot.simulated import WorldFile; \
world = WorldFile(Path(sys.argv[1])); world.take('r1'); print('taken', flush=True); sys.stdin.read()"


def taking(path: Path) -> "subprocess.Popen[str]":
    command = [sys.executable, "-c", TAKE, str(path)]
    return subprocess.Popen(
        command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.slow
def test_a_second_process_of_that_name_is_refused_until_the_first_one_is_gone(tmp_path: Path) -> None:
    with taking(tmp_path / "world") as first:
        assert first.stdout is not None
        assert first.stdout.readline() == "taken\n"
        with taking(tmp_path / "world") as second:
            said = second.communicate()[1]
        assert "BodyTaken: r1 is in the world" in said
        assert "--name" in said
        first.kill()
    with taking(tmp_path / "world") as third:
        assert third.communicate()[0] == "taken\n"
