"""The real service, killed ten times while people order and robots carry: nothing is lost and nothing doubled.

Three hundred kills: `make bench-service-kills`.
"""

from pathlib import Path

import pytest

from benchmarks.service_kills.run import Plan, killed

# Alone: beside whole missions nothing was done for the minute after which it counts as stuck.
pytestmark = [pytest.mark.system, pytest.mark.alone]


@pytest.mark.nightly
async def test_ten_kills_lose_and_double_nothing(tmp_path: Path) -> None:
    plan = Plan(kills=10, senders=4, robots=3, order_pause_s=0.05, longest_s=0.6)
    report = await killed(plan, tmp_path)
    assert report["wrong"] == []
    assert report["kills"] == 10
    assert report["orders"] >= 2 * plan.senders, "before, and after"
    assert report["robot_connections"] > plan.robots
