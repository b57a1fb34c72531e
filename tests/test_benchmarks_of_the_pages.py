"""The benchmark of the pages runs, and what is no matter of time holds on any machine."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.body.report import missed

CHECKOUT = Path(__file__).parents[1]
BOUNDS = {"order": {"transferred_kb": 100, "calls": 5}, "mailroom": {"transferred_kb": 120, "calls": 12}}


@pytest.mark.nightly
def test_a_first_page_transfers_little_asks_for_little_and_moves_nothing() -> None:
    command = [sys.executable, "-m", "benchmarks.pages", *BOUNDS, "--runs", "1", "--json"]
    finished = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    parts = json.loads(finished.stdout)["parts"]
    assert set(parts) == set(BOUNDS), finished.stderr
    for page, bounds in BOUNDS.items():
        figures = parts[page]["figures"]
        assert {one["figure"]: one["at_most"] for one in parts[page]["wanted"]}.items() >= bounds.items()
        assert 20 < figures["transferred_kb"] <= bounds["transferred_kb"]
        assert 3 < figures["calls"] <= bounds["calls"]
        assert figures["layout_shift"] <= 0.05
        assert figures["usable_ms"] > 0
    assert finished.returncode == bool(missed(parts))
