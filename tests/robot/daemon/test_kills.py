"""SIGKILL of the real daemon, a process joined to a service, at ten moments of missions with mail."""

from typing import Any

import pytest

from benchmarks.body import kills
from benchmarks.body.report import Samples, part_report

KILLS = 10


@pytest.mark.system
@pytest.mark.timeout(480)
@pytest.mark.nightly
def test_a_robot_killed_at_any_moment_knows_mission_cargo_and_grants_and_delivers_what_it_carries() -> None:
    report: dict[str, Any] = part_report(kills, Samples(kills=KILLS, first_seed=7))
    figures = report["figures"]
    assert figures["wrong"] == []
    assert figures["kills"] == KILLS
    assert {"claiming", "loading", "driving with mail", "handing over"} <= figures["moments"].keys()
    assert [row["figure"] for row in report["wanted"] if not row["met"]] == []
