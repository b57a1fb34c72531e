"""The service takes no more processor time than it did, beside two yardsticks of the machine from the same run.

`benchmarks/service/kept_ratios.json` says what it took, and at which commit. Write it anew, on a machine with nothing
else to do, by the command in `docs/how-to/measure.md`.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from benchmarks.service.yardsticks import KEPT, slower_by

CHECKOUT = Path(__file__).parents[2]
MAY_BE_SLOWER_BY = 1.25
TRIES = 3
"""Other work on the machine makes a run slower, never quicker."""
SHORT = ("orders", "instructions", "robots", "--seconds", "4", "--rounds", "2", "--robots", "100", "--json")


def measured() -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.service", *SHORT]
    finished = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    report: dict[str, Any] = json.loads(finished.stdout)
    assert [part for part in report["parts"].values() if "failed" in part] == [], finished.stderr
    assert report["commit"], "every figure names its commit"
    return report


@pytest.mark.nightly
@pytest.mark.alone
@pytest.mark.timeout(360)
def test_the_service_is_no_slower_than_it_was() -> None:
    kept, runs = json.loads(KEPT.read_text())["ratios"], list[dict[str, float]]()
    for _ in range(TRIES):
        runs.append(slower_by(measured()["ratios"], kept))
        if max(runs[-1].values()) <= MAY_BE_SLOWER_BY:
            return
    raise AssertionError(f"slower than at the commit of {KEPT.name}, by these factors in {TRIES} runs: {runs}")


def test_a_machine_of_another_kind_is_no_slower_service_and_a_slower_service_is() -> None:
    kept = {"report": {"to_python_loop_ms": 0.1, "to_bare_insert_ms": 1.0}}
    assert slower_by({"report": {"to_python_loop_ms": 0.2, "to_bare_insert_ms": 1.0}}, kept) == {"report": 1.0}
    assert slower_by({"report": {"to_python_loop_ms": 0.2, "to_bare_insert_ms": 1.5}}, kept) == {"report": 1.5}
