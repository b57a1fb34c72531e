"""The paper's own program, unmodified, on the simulated robot: the run of its section 6.3."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.robot.daemon.simulated_run import SimulatedRun

PROGRAM = Path(__file__).parents[4] / "shared" / "cases" / "paper" / "mail.asl"
pytestmark = pytest.mark.skipif(not PROGRAM.exists(), reason="the paper's program lies in ../shared, which is absent")


@contextmanager
def papers_run(folder: Path, **settings: object) -> Iterator[SimulatedRun]:
    run = SimulatedRun(folder, "post2:post1", mind__program=PROGRAM, **settings)
    run.asks("dockStation(post5)", "collectAndDeliverMail(post1,post4)")
    yield run
    run.close()


@pytest.mark.nightly
def test_it_collects_at_post1_and_reaches_post4(tmp_path: Path) -> None:
    with papers_run(tmp_path) as run:
        run.until(lambda: run.mind.is_quiet and run.mind.cycles > 10)
        assert run.visited == ["post2", "post1", "post1_bay2", "post1", "post2", "post3", "post4", "post4_bay2"]
        assert run.mind.failures == []


@pytest.mark.nightly
def test_a_low_battery_on_the_way_is_charged_at_the_dock_it_was_told_and_post4_is_reached(tmp_path: Path) -> None:
    with papers_run(tmp_path, battery_ratio=0.26, battery__simulated_capacity_mah=1500.0) as run:
        run.until(lambda: run.robot.docked)
        assert run.is_at("post5"), "dockStation(post0) is in the program; the newer belief comes first"
        run.until(lambda: run.mind.is_quiet and not run.robot.docked)
        to_the_dock = ["post2", "post1", "post1_bay2", "post1", "post2", "post3", "post5", "post5_bay1"]
        assert run.visited == [*to_the_dock, "post5", "post3", "post4", "post4_bay2"]
        assert run.did.count("station(dock)") == 1
