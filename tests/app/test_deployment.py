"""Files shipped to run the service: units that systemd takes, proxies that pass on what they must."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from app.core.settings import ROOT

DEPLOY = ROOT / "deploy"
UNITS = ("campus-mail.service", "campus-mail-backup.service", "campus-mail-backup.timer")


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="there is no systemd here")
def test_systemd_finds_nothing_wrong_with_the_units(tmp_path: Path) -> None:
    for name in UNITS:
        text = (DEPLOY / name).read_text().replace("/opt/campus-mail/.venv/bin/python", sys.executable)
        (tmp_path / name).write_text(text)
    verify = ["systemd-analyze", "verify", "--man=no", *(str(tmp_path / name) for name in UNITS)]
    ran = subprocess.run(verify, capture_output=True, text=True, check=False)
    assert [line for line in ran.stderr.splitlines() if "campus-mail" in line] == []


def test_service_backup_and_commands_have_the_same_secrets() -> None:
    """A backup without the database's address would be one of another database."""
    handed_over = "LoadCredential=campus_mail:/etc/campus-mail/secrets"
    for name in ("campus-mail.service", "campus-mail-backup.service"):
        assert handed_over in (DEPLOY / name).read_text().splitlines()
    assert f"--property={handed_over}" in (ROOT / "docs" / "how-to" / "install-the-service.md").read_text()


def test_no_proxy_shows_the_figures_or_holds_back_an_event() -> None:
    nginx, caddy = ((DEPLOY / name).read_text() for name in ("nginx.conf", "Caddyfile"))
    assert "location = /metrics { return 404; }" in nginx
    assert "respond /metrics 404" in caddy
    assert "proxy_buffering off;" in nginx.partition("location = /api/v1/live")[2].partition("}")[0]
    assert "flush_interval -1" in caddy
    # A proxy_set_header in a location replaces all of the server's, and with them whom the service has to believe.
    server, _, locations = nginx.partition("location =")
    assert {"X-Forwarded-For", "X-Forwarded-Proto", "Upgrade", "Host"} <= set(server.split())
    assert "proxy_set_header" not in locations


def test_backups_are_kept_for_thirty_nights(tmp_path: Path) -> None:
    """By the unit's own command, in a folder of the test."""
    unit = (DEPLOY / "campus-mail-backup.service").read_text()
    [command] = [line.partition("=")[2] for line in unit.splitlines() if line.startswith("ExecStartPost=")]
    names = {"mail-old.tar.gz": 32, "mail-young.tar.gz": 29, "of-another.tar.gz": 400}
    for name, age_days in names.items():
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (time.time() - age_days * 86_400,) * 2)
    words = [str(tmp_path) if word == "/var/lib/campus-mail-backups" else word for word in command.split()]
    assert str(tmp_path) in words
    subprocess.run(words, check=True, timeout=10)
    assert {path.name for path in tmp_path.iterdir()} == names.keys() - {"mail-old.tar.gz"}
