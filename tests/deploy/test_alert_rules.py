"""The alert rules name only metrics that a started service exports, and promtool accepts them."""

import os
import re
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest

ROOT = Path(__file__).parents[2]
RULES = ROOT / "deploy" / "prometheus" / "campus-mail.rules.yaml"
RULE_TESTS = Path(__file__).with_name("alerts.yaml")


def _exported_names(data: Path) -> set[str]:
    """Start the service on a free port and return the metrics it declares."""
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
                return set(re.findall(r"^# TYPE (\S+)", text, re.MULTILINE))
            except httpx.TransportError:
                assert service.poll() is None, (data / "log").read_text()
                time.sleep(0.2)
        raise AssertionError((data / "log").read_text())
    finally:
        service.terminate()
        service.wait(30)


def test_each_metric_in_the_rules_is_exported(tmp_path: Path) -> None:
    named = set(re.findall(r"campus_mail_\w+", RULES.read_text()))
    assert named
    assert named <= _exported_names(tmp_path)


@pytest.mark.skipif(shutil.which("promtool") is None, reason="promtool is missing (Debian package prometheus)")
def test_promtool_accepts_the_rules_and_their_unit_tests() -> None:
    for arguments in (["check", "rules", str(RULES)], ["test", "rules", str(RULE_TESTS)]):
        ran = subprocess.run(["promtool", *arguments], capture_output=True, text=True, check=False)
        assert ran.returncode == 0, ran.stdout + ran.stderr
