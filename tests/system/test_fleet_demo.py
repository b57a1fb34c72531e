"""The demonstration of the fleet: real daemons and the real service in the tunnels of Carleton."""

import json
import subprocess
import sys

import pytest

from tests.system.rig import ROOT

pytestmark = [pytest.mark.system, pytest.mark.timeout(200)]


def test_two_robots_of_the_fleet_deliver_an_order_each_and_never_meet() -> None:
    command = [sys.executable, "-m", "app", "fleet-demo", "--once", "--json", "--port", "0"]
    command += ["--robots", "2", "--scale", "0.05"]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=180)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    summary = json.loads(ran.stdout)
    assert summary["ended"] == {"delivered": 2}
    assert summary["delivered_by"] == {"r1": 1, "r2": 1}
    assert summary["two_in_one_corridor"] == 0
    assert summary["corridors_entered_or_left"] >= 2 * 2
    assert summary["looks_at_true_places"] > 20
