"""Killed in the middle of a turn on a crossing: the base counts on, and tells which way the robot looks then."""

import math
from pathlib import Path

import pytest

from robot.scenarios.places import corridor_at
from robot.simulated.start import start_pose
from tests.robot.daemon.played_service import PlayedService
from tests.robot.daemon.simulated_run import SimulatedRun


def joined(folder: Path, service: PlayedService | None = None) -> tuple[SimulatedRun, PlayedService]:
    run = SimulatedRun(folder)
    service = service or PlayedService(run.missions)
    service.missions = run.missions
    run.missions.join(service)
    run.asks("", "visit(post2)")
    return run, service


def killed_at_post3(folder: Path, turned_deg: float) -> PlayedService:
    """On its way from post5 it comes to a crossing of four lines, and turns right there."""
    run, service = joined(folder)
    run.until(lambda: run.parts.navigator.crossing == "post3")
    begun_rad = run.robot.pose.heading_rad
    run.until(lambda: abs(math.degrees(math.remainder(run.robot.pose.heading_rad - begun_rad, math.tau))) > turned_deg)
    run.kill()
    return service


def corridor_of(run: SimulatedRun) -> str | None:
    return corridor_at(run.parts.navigator.campus, run.robot.pose.x_m, run.robot.pose.y_m)


@pytest.mark.parametrize("turned_deg", [10.0, 44.0, 80.0])
def test_it_turns_on_and_takes_the_line_that_it_was_turning_to(tmp_path: Path, turned_deg: float) -> None:
    service = killed_at_post3(tmp_path, turned_deg)
    held = list(service.held)
    run, _ = joined(tmp_path, service)
    driven = set[str | None]()
    run.until(lambda: run.is_at("post2") or driven.add(corridor_of(run)), 60)
    assert driven <= {"post2-post3", None}
    assert "find_line" not in run.did
    assert set(service.held) <= set(held), "it asks for no other line of the post"
    run.close()


def test_one_whose_base_was_switched_off_too_stands_until_a_person_puts_it_into_a_bay(tmp_path: Path) -> None:
    service = killed_at_post3(tmp_path, 44.0)
    held = list(service.held)
    run, _ = joined(tmp_path, service)
    run.robot.set_fault("encoder_offset", 4000)
    pose = run.robot.pose
    run.until(lambda: "fault place_unknown" in run.told(), 30)
    run.passes(30)
    assert run.robot.pose == pose
    assert run.mind.why and run.mind.why.sentence == "Waiting to be put down at a post or in a dock"
    assert service.held == held
    run.robot.lift(True)
    run.passes(1)
    run.robot.place(start_pose(run.parts.navigator.campus, "post1:post1_bay1"))
    run.robot.lift(False)
    run.passes(1)
    run.robot.press("spot")
    run.until(lambda: run.is_at("post2"))
    assert run.told().count("fault place_unknown") == 2, "begun and over"
    run.close()
