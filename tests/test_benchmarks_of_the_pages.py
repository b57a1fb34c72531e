"""The benchmark of the pages runs, and what is no matter of time holds on any machine."""

import json
import subprocess
import sys
from pathlib import Path

from benchmarks.body.report import missed

CHECKOUT = Path(__file__).parents[1]


def test_a_first_order_page_transfers_at_most_100_kb_and_moves_nothing() -> None:
    command = [sys.executable, "-m", "benchmarks.pages", "order", "--runs", "1", "--json"]
    finished = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    parts = json.loads(finished.stdout)["parts"]
    assert set(parts) == {"order"}, finished.stderr
    figures = parts["order"]["figures"]
    assert 20 < figures["transferred_kb"] <= 100
    assert figures["layout_shift"] <= 0.05
    assert figures["usable_ms"] > 0
    assert finished.returncode == bool(missed(parts))
