"""Errors that keep the service from starting: one sentence with a way out each, and nothing is half done."""

import asyncio
import logging
import os
import resource
import signal
import socket
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

import pytest
import structlog
from alembic import command
from alembic.config import Config
from sqlalchemy import inspect
from sqlalchemy.exc import StatementError
from typer.testing import CliRunner

from app.__main__ import app as commands
from app.cli.administration import migrate
from app.cli.serving import PortInUse, listen, serve
from app.core.database.database import Database
from app.core.database.schema_version import INI, DatabaseUnusable, NewerDatabase, bring_to_head, is_at_head
from app.core.errors import StartError
from app.core.logs import redact
from app.core.server_key import open_server_key
from app.core.settings import Settings, open_clock, open_map
from app.models import Person
from app.models.columns import NaiveTime
from demo.__main__ import app as demonstrations
from docs.site import reference
from tests.app.conftest import sqlite_alone
from tests.app.notifications.receivers import certificate

ROOT = INI.parent


@pytest.fixture(autouse=True)
def _logs_as_before() -> Iterator[None]:
    """Commands that run in this process set logging up for themselves."""
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)
    structlog.reset_defaults()


@pytest.fixture
def sqlite_at_head() -> None:
    """Here migrations begin at nothing."""


async def test_a_new_database_is_at_head_and_owned_by_us_alone(settings: Settings) -> None:
    await migrate(settings)
    assert settings.data.stat().st_mode & 0o777 == 0o700
    database = Database(settings.url_of_database)
    assert await is_at_head(database)
    await bring_to_head(database)
    await database.close()


async def test_the_models_and_the_migrations_say_the_same(settings: Settings) -> None:
    """Alembic's own check: it would find nothing to migrate."""
    database = Database(settings.url_of_database)
    await bring_to_head(database)
    config = Config(INI)

    def check(connection: object) -> None:
        config.attributes["connection"] = connection
        command.check(config)

    async with database.engine.connect() as connection:
        await connection.run_sync(check)
    await database.close()


@pytest.mark.slow
async def test_the_first_migration_can_be_undone(settings: Settings) -> None:
    database = Database(settings.url_of_database)
    await bring_to_head(database)
    config = Config(INI)

    def undo(connection: object) -> None:
        config.attributes["connection"] = connection
        command.downgrade(config, "base")

    async with database.writing.begin() as connection:
        await connection.run_sync(undo)
    async with database.engine.connect() as connection:
        tables = await connection.run_sync(lambda plain: inspect(plain).get_table_names())
    await database.close()
    assert tables == ["alembic_version"]


@sqlite_alone
@pytest.mark.slow
def test_a_database_of_a_newer_version_is_refused_and_left_alone(settings: Settings) -> None:
    asyncio.run(migrate(settings))
    file = settings.data / "campus-mail.sqlite"
    with sqlite3.connect(file) as plain:
        plain.execute("update alembic_version set version_num = '9999'")
    plain.close()
    before = file.read_bytes()
    with pytest.raises(NewerDatabase, match="written by a newer one"):
        asyncio.run(migrate(settings))
    assert file.read_bytes() == before
    command_line = [sys.executable, "-m", "app", "serve", "--port", "0"]
    environment = {**os.environ, "CAMPUS_MAIL_DATA": str(settings.data)}
    ran = subprocess.run(
        command_line, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert (ran.returncode, ran.stdout) == (2, "")
    assert "9999" in ran.stderr
    assert "Traceback" not in ran.stderr


@pytest.mark.parametrize(
    ("url", "named"),
    [
        ("nonsense", "CAMPUS_MAIL_DATABASE_URL"),
        ("foo://ada:secret@here", "CAMPUS_MAIL_DATABASE_URL"),
        ("sqlite+aiosqlite:////nowhere/at/all.sqlite", "unable to open database file"),
    ],
)
def test_a_database_that_leads_nowhere_is_named_without_its_password(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, url: str, named: str
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path))
    monkeypatch.setenv("CAMPUS_MAIL_DATABASE_URL", url)
    ran = CliRunner().invoke(commands, ["migrate"])
    assert ran.exit_code == 2
    assert named in ran.stderr
    assert "secret" not in ran.stderr


@sqlite_alone
def test_a_file_that_is_no_database_is_named_and_left_as_it_is(settings: Settings) -> None:
    settings.data.mkdir(exist_ok=True)
    file = settings.data / "campus-mail.sqlite"
    file.write_text("somebody's shopping list, and not a database of ours")
    with pytest.raises(DatabaseUnusable, match="file is not a database"):
        asyncio.run(migrate(settings))
    assert file.read_text().startswith("somebody's")


def test_a_taken_port_is_named_with_a_way_out_and_nothing_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with listen("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(PortInUse, match=f"--port {port + 1}"):
            listen("127.0.0.1", port)
        monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))
        served = CliRunner().invoke(commands, ["serve", "--port", str(port)])
        shown = CliRunner().invoke(demonstrations, ["letter", "--once", "--json", "--port", str(port)])
        driven = CliRunner().invoke(demonstrations, ["fleet", "--json", "--port", str(port)])
    for verb, ran in {"serve": served, "demo": shown, "fleet-demo": driven}.items():
        assert (ran.exit_code, ran.stdout) == (2, "")
        assert f"Port {port} on 127.0.0.1 is taken" in ran.stderr
        assert f'make {verb} ARGS="--port {port + 1}"' in ran.stderr
    assert not (tmp_path / "data").exists()


async def test_no_answer_is_held_back_until_the_one_before_is_acknowledged() -> None:
    """Nagle's algorithm keeps the body of an answer 40 ms back; a loop that is not uvloop leaves it on by itself."""
    held_back: asyncio.Future[bool] = asyncio.get_running_loop().create_future()

    async def connected(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        ours = writer.get_extra_info("socket")
        held_back.set_result(not ours.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        writer.close()

    with listen("127.0.0.1", 0) as listening:
        async with await asyncio.start_server(connected, sock=listening), asyncio.timeout(10):
            _, writer = await asyncio.open_connection(*listening.getsockname())
            was_held_back = await held_back
            writer.close()
    assert not was_held_back


def test_an_address_of_another_machine_is_named() -> None:
    with pytest.raises(StartError, match=r"Cannot listen on 192\.0\.2\.1"):
        listen("192.0.2.1", 0)


def test_an_unknown_map_is_named(settings: Settings) -> None:
    with pytest.raises(StartError, match=r"The map cannot be used\. atlantis"):
        open_map(settings.model_copy(update={"map": "atlantis"}))


def test_an_absent_clock_file_is_named(settings: Settings, tmp_path: Path) -> None:
    with pytest.raises(StartError, match="clock"):
        open_clock(settings.model_copy(update={"clock_file": tmp_path / "clock"}))


@pytest.mark.parametrize("content", ["", "00ff", "z" * 64])
def test_a_damaged_server_key_is_never_replaced(tmp_path: Path, content: str) -> None:
    path = tmp_path / "server.key"
    path.touch(mode=0o600)
    path.write_text(content)
    with pytest.raises(StartError, match="server key"):
        open_server_key(path)
    assert path.read_text() == content


def test_a_server_key_that_others_can_read_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "server.key"
    open_server_key(path)
    path.chmod(0o644)
    with pytest.raises(StartError, match="0600"):
        open_server_key(path)


def test_every_setting_is_described_in_the_docs() -> None:
    page = reference.settings()
    for name, field in Settings.model_fields.items():
        assert field.description, name
        assert f"`CAMPUS_MAIL_{name.upper()}`" in page, name


def test_every_command_is_described_in_the_docs() -> None:
    page = reference.commands()
    for words in ("demo letter", "demo fleet", *(f"app {one}" for one in ("serve", "migrate", *_subcommands()))):
        assert f"`python -m {words}`" in page, words


def _subcommands() -> Iterator[str]:
    for group in commands.registered_groups:
        assert group.typer_instance is not None
        for one in group.typer_instance.registered_commands:
            assert one.callback is not None
            yield f"{group.name} {one.name or one.callback.__name__}"
    for one in commands.registered_commands:
        assert one.callback is not None
        yield one.name or one.callback.__name__.replace("_", "-")


async def test_a_time_without_a_zone_is_never_stored(settings: Settings) -> None:
    await migrate(settings)
    database = Database(settings.url_of_database)
    naive = datetime(2026, 1, 5, 9, 0)  # noqa: DTZ001  # that is the point
    with pytest.raises(StatementError) as caught:
        async with database.transaction() as session:
            session.add(Person(id="p", email="p@campus.example", name="P", created_at=naive))
    assert isinstance(caught.value.orig, NaiveTime)
    await database.close()


def test_roles_are_given_on_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))
    given = CliRunner().invoke(commands, ["people", "role", "Dan@Campus.Example", "--add", "dispatcher"])
    assert (given.exit_code, given.stdout.strip()) == (0, "Dan@Campus.Example: dispatcher, member")
    refused = CliRunner().invoke(commands, ["people", "role", "dan@campus.example", "--add", "boss"])
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert "There are: member, dispatcher, maintainer" in refused.stderr


@pytest.mark.parametrize("address", ["nonsense", "dan@elsewhere.example"])
def test_no_person_gets_a_role_who_could_never_sign_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, address: str
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))
    refused = CliRunner().invoke(commands, ["people", "role", address, "--add", "maintainer"])
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert f"{address} could not sign in: addresses of campus.example can" in refused.stderr
    assert CliRunner().invoke(commands, ["people", "list"]).stdout == "No people yet.\n"


@sqlite_alone
def test_a_command_that_the_database_fails_says_so_and_changes_nothing(settings: Settings) -> None:
    asyncio.run(migrate(settings))
    refuses = "create trigger full before insert on people begin select raise(abort, 'database or disk is full'); end"
    with sqlite3.connect(settings.data / "campus-mail.sqlite") as plain:
        plain.execute(refuses)
    plain.close()
    environment = {"CAMPUS_MAIL_DATA": str(settings.data)}
    given = ["people", "role", "dan@campus.example", "--add", "maintainer"]
    ran = CliRunner(env=environment).invoke(commands, given)
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert ran.stderr.splitlines() == [
        "campus-mail: The database could not be used, and nothing was changed: database or disk is full."
    ]
    assert CliRunner(env=environment).invoke(commands, ["people", "list"]).stdout == "No people yet.\n"


@sqlite_alone
@pytest.mark.slow
def test_a_first_start_on_a_full_disk_says_that_it_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))
    ran = _with_files_no_larger_than(100_000, [sys.executable, "-m", "app", "migrate"])
    assert ran.returncode == 2
    assert "full" in ran.stderr or "disk I/O error" in ran.stderr


def _with_files_no_larger_than(bytes_: int, command_line: list[str]) -> subprocess.CompletedProcess[str]:
    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_))

    return subprocess.run(
        command_line, cwd=ROOT, capture_output=True, text=True, timeout=60, check=False, preexec_fn=limit
    )


def test_a_key_for_which_there_is_no_room_leaves_no_file_behind(tmp_path: Path) -> None:
    script = f"import sys; sys.path.insert(0, {str(ROOT)!r})\n" + (
        "from pathlib import Path\nfrom app.core.server_key import open_server_key\n"
        f"open_server_key(Path({str(tmp_path / 'server.key')!r}))"
    )
    ran = _with_files_no_larger_than(10, [sys.executable, "-B", "-c", script])
    assert "server.key cannot be used" in ran.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_robot_is_enrolled_once_and_given_a_new_token_on_demand(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))
    first = CliRunner().invoke(commands, ["robots", "enrol", "r1", "--token"])
    assert first.stdout.startswith("cmr_")
    refused = CliRunner().invoke(commands, ["robots", "enrol", "r1", "--token"])
    assert (refused.exit_code, refused.stdout) == (2, "")
    again = CliRunner().invoke(commands, ["robots", "enrol", "r1", "--token", "--again"])
    assert again.stdout.startswith("cmr_")
    assert again.stdout != first.stdout


def test_no_secret_reaches_a_log() -> None:
    event = {
        "event": "code CM1:0123456789abcdef0123456789abcdef and 12345678, session=abc.def; token cmr_01234567_aB-c",
        "Authorization": "Bearer x",
        "deep": {"token": "x", "list": ["cmr_01234567_secret"]},
        "order": "cf179875c3a1ccbd",
    }
    said = str(redact(None, "info", dict(event)))
    for secret in ("0123456789abcdef", "12345678,", "abc.def", "aB-c", "Bearer", "secret"):
        assert secret not in said
    assert "cf179875c3a1ccbd" in said


def test_certificate_and_key_that_do_not_fit_are_named_before_anything_is_made(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "other").mkdir()
    chain, _ = certificate(tmp_path / "one")
    certificate(tmp_path / "other")
    settings = Settings(data=tmp_path / "data", tls_cert=chain, tls_key=tmp_path / "other" / "server.key")
    with pytest.raises(StartError, match="do not belong together"):
        serve(settings)
    absent = settings.model_copy(update={"tls_key": tmp_path / "nowhere.key"})
    with pytest.raises(StartError, match=r"nowhere\.key cannot be used: No such file or directory"):
        serve(absent)
    with pytest.raises(StartError, match="both are needed"):
        serve(settings.model_copy(update={"tls_key": None}))
    assert not (tmp_path / "data").exists()
