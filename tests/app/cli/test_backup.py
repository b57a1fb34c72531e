"""A backup is whole or it is not there; a restore puts it in place and loses nothing of what was there before."""

import asyncio
import json
import sqlite3
import tarfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from app.cli.administration import migrate
from app.core.settings import Settings
from app.retention.data_folder_lock import the_only_one
from tests.app.cli.conftest import Run
from tests.app.conftest import ON_POSTGRESQL, RECIPIENT, Browser, Mailroom, sqlite_alone
from tests.app.postgresql import PROGRAMS

CHECKOUT = Path(__file__).parents[3]

Ask = Callable[..., Any]


@pytest.fixture(autouse=True)
def _client_programs(monkeypatch: pytest.MonkeyPatch) -> None:
    """pg_dump and pg_restore of the tests' own PostgreSQL."""
    if ON_POSTGRESQL:
        monkeypatch.setenv("PATH", f"{PROGRAMS}:/usr/bin:/bin")


@pytest.fixture
def archive(ask: Ask, sender: Browser, mailroom: Mailroom, tmp_path: Path) -> Path:
    """A backup, beside the running service, with one order that is on its way."""
    order_id = sender.order().json()["id"]
    mailroom.move(order_id, "assigned", "to_sender")
    ask("backup", str(tmp_path / "mail.tar.gz"))
    sender.order()
    return tmp_path / "mail.tar.gz"


def of_another(settings: Settings, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """From here on commands are about another data folder (and, where there is one, the same server)."""
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(folder))


def newest_revision() -> str:
    return max(path.name[:4] for path in (CHECKOUT / "migrations" / "versions").glob("0*.py"))


def test_a_backup_says_what_it_holds_and_is_for_its_owner_alone(archive: Path) -> None:
    with tarfile.open(archive) as file:
        names = file.getnames()
        content = file.extractfile("manifest.json")
        assert content is not None
        manifest = json.load(content)
    database = "campus-mail.dump" if ON_POSTGRESQL else "campus-mail.sqlite"
    assert {database, "server.key", "manifest.json"} <= set(names)
    assert all(len(entry["sha256"]) == 64 for entry in manifest["files"])
    assert archive.stat().st_mode & 0o777 == 0o600
    if not ON_POSTGRESQL:
        assert (manifest["rows"]["orders"], manifest["revision"]) == (1, newest_revision())


@sqlite_alone
def test_a_restored_service_has_the_orders_of_that_moment_and_the_same_codes(
    archive: Path, ask: Ask, run: Run, settings: Settings, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    of_another(settings, monkeypatch, tmp_path / "restored")
    assert run("restore", str(archive)).exit_code == 0
    (order,) = ask("orders", "list")
    assert (order["state"], order["recipient"]) == ("to_sender", RECIPIENT)
    assert (tmp_path / "restored" / "server.key").read_bytes() == settings.server_key_path.read_bytes()


def test_nothing_is_overwritten_and_what_was_there_is_kept_aside(
    archive: Path, ask: Ask, run: Run, settings: Settings
) -> None:
    refused = run("restore", str(archive))
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert "--replace" in refused.stderr
    assert len(ask("orders", "list")) == 2
    restored = ask("restore", str(archive), "--replace")
    assert [order["state"] for order in ask("orders", "list")] == ["to_sender"]
    (aside,) = settings.data.glob("before-restore-*")
    assert restored["kept_aside"] == str(aside)
    kept = {path.name for path in aside.iterdir()}
    assert "server.key" in kept
    assert kept & {"campus-mail.sqlite", "campus-mail.dump"}


@sqlite_alone
def test_a_restore_that_cannot_put_everything_in_place_leaves_what_was_there(
    archive: Path, ask: Ask, run: Run, settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_SERVER_KEY_FILE", "/nowhere/server.key")
    refused = run("restore", str(archive), "--replace")
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert (
        "/nowhere/server.key cannot be written: No such file or directory. Nothing has been changed" in refused.stderr
    )
    assert len(ask("orders", "list")) == 2
    assert list(settings.data.glob("before-restore-*")) == []


def test_a_service_that_runs_is_not_restored_over(archive: Path, run: Run, settings: Settings) -> None:
    with the_only_one(settings, "…"):
        refused = run("restore", str(archive), "--replace")
        served = run("serve", "--port", "0")
    assert refused.exit_code == served.exit_code == 2
    assert "A service is running" in refused.stderr
    assert "Stop it first" in refused.stderr
    assert "A service is running" in served.stderr


def test_a_damaged_archive_changes_nothing(archive: Path, run: Run, ask: Ask, tmp_path: Path) -> None:
    content = archive.read_bytes()
    damaged = tmp_path / "damaged.tar.gz"
    for wrong in (content[: len(content) // 2], b"no archive", content[:-400] + bytes(400)):
        damaged.write_bytes(wrong)
        refused = run("restore", str(damaged), "--replace")
        assert (refused.exit_code, refused.stdout) == (2, "")
        assert str(damaged) in refused.stderr
    assert len(ask("orders", "list")) == 2


def test_an_archive_whose_files_were_exchanged_is_refused(archive: Path, run: Run, tmp_path: Path) -> None:
    with tarfile.open(archive) as file:
        file.extractall(tmp_path / "open", filter="data")
    (tmp_path / "open" / "server.key").write_text("0" * 64)
    with tarfile.open(tmp_path / "forged.tar.gz", "w:gz") as file:
        for path in (tmp_path / "open").iterdir():
            file.add(path, arcname=path.name)
    refused = run("restore", str(tmp_path / "forged.tar.gz"), "--replace")
    assert refused.exit_code == 2
    assert "server.key is not what was written" in refused.stderr


@sqlite_alone
@pytest.mark.parametrize(
    ("damage", "named"),
    [
        ("PRAGMA foreign_keys=OFF; DELETE FROM people", "foreign key"),
        ("UPDATE orders SET state = 'delivered'", "its last event says"),
        ("DELETE FROM order_events WHERE seq = 1", "events go from"),
    ],
)
@pytest.mark.slow
def test_what_is_not_sound_is_not_called_a_backup(
    sender: Browser, mailroom: Mailroom, run: Run, settings: Settings, tmp_path: Path, damage: str, named: str
) -> None:
    mailroom.move(sender.order().json()["id"], "assigned")
    with sqlite3.connect(settings.data / "campus-mail.sqlite") as plain:
        plain.executescript(damage)
    plain.close()
    refused = run("backup", str(tmp_path / "mail.tar.gz"))
    assert refused.exit_code == 2
    assert named in refused.stderr
    assert not (tmp_path / "mail.tar.gz").exists()


def test_a_backup_is_never_written_over_another(archive: Path, run: Run) -> None:
    before = archive.read_bytes()
    assert "exists already" in run("backup", str(archive)).stderr
    assert archive.read_bytes() == before


def test_a_backup_of_postgresql_without_its_programs_says_what_to_install(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("CAMPUS_MAIL_DATABASE_URL", "postgresql+asyncpg://mail:secret@127.0.0.1:1/mail")
    refused = run("backup", str(tmp_path / "mail.tar.gz"))
    assert refused.exit_code == 2
    assert "apt install postgresql-client" in refused.stderr
    assert "secret" not in refused.stderr


def test_the_lock_ends_with_its_holder(settings: Settings) -> None:
    asyncio.run(migrate(settings))
    for _ in range(2):
        with the_only_one(settings, "…"):
            pass
