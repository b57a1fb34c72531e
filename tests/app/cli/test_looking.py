"""The commands with which an operator looks at people, robots, orders and the map."""

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from typer.testing import CliRunner

from app.__main__ import app as commands
from tests.app.cli.conftest import Run
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom

Ask = Callable[..., Any]


def test_help_names_every_command_and_says_what_it_is_for() -> None:
    said = CliRunner().invoke(commands, ["--help"]).output
    for word in ("serve", "migrate", "people", "robots", "orders", "map", "export", "erase", "retain"):
        assert word in said
    assert "Exit status" in said


def test_people_are_listed_and_shown(run: Run, ask: Ask, sender: Browser) -> None:
    sender.order()
    assert {person["email"] for person in ask("people", "list")} == {SENDER, RECIPIENT}
    shown = ask("people", "show", SENDER)
    assert (shown["orders_sent"], shown["orders_received"], shown["sessions"]) == (1, 0, 1)
    assert run("people", "role", SENDER, "--add", "dispatcher").exit_code == 0
    assert [person["email"] for person in ask("people", "list", "--role", "dispatcher")] == [SENDER]
    assert SENDER in run("people", "list").stdout


def test_an_order_is_shown_with_its_timeline_and_without_anybodys_code(
    run: Run, ask: Ask, sender: Browser, mailroom: Mailroom
) -> None:
    order_id = sender.order(description="Keys").json()["id"]
    mailroom.move(order_id, "assigned", "to_sender")
    assert [order["id"] for order in ask("orders", "list", "--state", "to_sender")] == [order_id]
    assert ask("orders", "list", "--state", "delivered") == []
    shown = ask("orders", "show", order_id)
    assert (shown["sender"], shown["recipient"], shown["description"]) == (SENDER, RECIPIENT, "Keys")
    assert [event["state"] for event in shown["events"]] == ["queued", "assigned", "to_sender"]
    text = run("orders", "show", order_id).stdout
    assert "timeline" in text
    assert "to_sender" in text
    assert "CM1:" not in text


def test_orders_go_into_a_spreadsheet_that_runs_nothing(run: Run, sender: Browser, tmp_path: Path) -> None:
    for description in ("=HYPERLINK(1)", 'two; "three"'):
        sender.order(description=description)
    rows = list(csv.DictReader(io.StringIO(run("orders", "csv").stdout)))
    assert {row["description"] for row in rows} == {"'=HYPERLINK(1)", 'two; "three"'}
    assert rows[0]["sender"] == SENDER
    file = tmp_path / "orders.csv"
    assert run("orders", "csv", "--to", str(file)).exit_code == 0
    assert file.stat().st_mode & 0o777 == 0o600
    again = run("orders", "csv", "--to", str(file))
    assert (again.exit_code, again.stdout) == (2, "")
    assert "cannot be written: File exists" in again.stderr


def test_what_is_not_there_is_said_in_a_sentence(run: Run, sender: Browser) -> None:
    for words in (
        ("orders", "show", "nothing"),
        ("people", "show", "nobody@campus.example"),
        ("robots", "revoke", "r9"),
    ):
        ran = run(*words)
        assert (ran.exit_code, ran.stdout) == (2, ""), words
        assert ran.stderr.startswith("campus-mail: ")
        assert "Traceback" not in ran.stderr


def test_robots_are_listed_and_their_tokens_revoked(run: Run, ask: Ask, sender: Browser) -> None:
    token = run("robots", "enrol", "r1", "--token").stdout.strip()
    (robot,) = ask("robots", "list")
    assert robot["tokens"] == [token.split("_")[1]]
    assert token.split("_")[2] not in json.dumps(robot)
    assert "1 tokens revoked" in run("robots", "revoke", "r1").stdout
    assert ask("robots", "list")[0]["tokens"] == []


def test_the_map_is_shown_and_checked(run: Run, ask: Ask) -> None:
    assert "post1" in {post["name"] for post in ask("map", "show")["posts"]}
    assert [problem["kind"] for problem in ask("map", "check")["problems"]] == []
    assert "post1" in run("map", "show").stdout
