"""Alert rules and dashboard name only metrics that a started service exports, and promtool accepts them."""

import json
import os
import re
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import httpx
import pytest

ROOT = Path(__file__).parents[2]
RULES = ROOT / "deploy" / "prometheus" / "campus-mail.rules.yaml"
DASHBOARD = ROOT / "deploy" / "grafana" / "campus-mail.json"
RULE_TESTS = Path(__file__).with_name("alerts.yaml")

PARTS = ("bucket", "count", "sum")

needs_promtool = pytest.mark.skipif(
    shutil.which("promtool") is None, reason="promtool is missing (Debian package prometheus)"
)


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """Start the service on a free port and return the metrics it declares."""
    data = tmp_path_factory.mktemp("service")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    environment = os.environ | {"CAMPUS_MAIL_DATA": str(data)}
    command = [sys.executable, "-m", "app", "serve", "--port", str(port)]
    with (data / "log").open("w") as log:
        service = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=log, stderr=log)
    try:
        for _ in range(300):
            try:
                text = httpx.get(f"http://127.0.0.1:{port}/metrics").text
                kinds = re.findall(r"^# TYPE (\S+) (\S+)", text, re.MULTILINE)
                parts = [f"{name}_{part}" for name, kind in kinds if kind == "histogram" for part in PARTS]
                return {name for name, _ in kinds}.union(parts)
            except httpx.TransportError:
                assert service.poll() is None, (data / "log").read_text()
                time.sleep(0.2)
        raise AssertionError((data / "log").read_text())
    finally:
        service.terminate()
        service.wait(30)


def _panels() -> list[dict[str, Any]]:
    dashboard: dict[str, Any] = json.loads(DASHBOARD.read_text())
    return list(dashboard["panels"])


def _expressions() -> list[str]:
    return [target["expr"] for panel in _panels() for target in panel.get("targets", ())]


@pytest.mark.slow
def test_each_metric_in_the_rules_and_the_dashboard_is_exported(exported: set[str]) -> None:
    for text in (RULES.read_text(), *_expressions()):
        named = set(re.findall(r"campus_mail_\w+", text))
        assert named or re.search(r"\b(up|scrape_duration_seconds)\b", text)
        assert named <= exported


def test_each_exported_metric_is_on_the_dashboard(exported: set[str]) -> None:
    """A part of a histogram stands for it."""
    text = " ".join(_expressions())
    assert not {name for name in exported if name not in text and not name.endswith(("_created", *PARTS))}


def test_the_panels_of_the_dashboard_stand_side_by_side() -> None:
    rows = [panel["title"] for panel in _panels() if panel["type"] == "row"]
    assert rows == ["Service", "Orders", "Robots", "Traffic", "Database"]
    places = [panel["gridPos"] for panel in _panels()]
    cells = [(x, y) for p in places for x in range(p["x"], p["x"] + p["w"]) for y in range(p["y"], p["y"] + p["h"])]
    assert len(cells) == len(set(cells))
    assert max(x for x, _ in cells) < 24


@needs_promtool
def test_promtool_accepts_the_rules_and_their_unit_tests() -> None:
    _promtool("check", "rules", RULES)
    _promtool("test", "rules", RULE_TESTS)


@needs_promtool
def test_promtool_accepts_the_expressions_of_the_dashboard(tmp_path: Path) -> None:
    expressions = [expression.replace("$__rate_interval", "5m") for expression in _expressions()]
    rules = [{"record": f"panel:{number}", "expr": one} for number, one in enumerate(expressions)]
    # JSON is YAML.
    (tmp_path / "rules.yaml").write_text(json.dumps({"groups": [{"name": "panels", "rules": rules}]}))
    _promtool("check", "rules", tmp_path / "rules.yaml")


def _promtool(*arguments: str | Path) -> None:
    ran = subprocess.run(["promtool", *arguments], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
