"""The demonstration of a fleet where there is no terminal to draw a table on."""

from dataclasses import replace
from pathlib import Path

import pytest

from app.core.mail import Mail
from app.core.mail import Spool as Writer
from demo.fleet.campus import campus_of
from demo.fleet.screen import FleetScreen
from demo.fleet.settings import FleetDemo
from demo.people import Spool
from protocol.clock import SharedClock, SteppedClock

NOW = SteppedClock().utc()
DEMO = FleetDemo(
    folder=Path("demo"),
    door=Path("door"),
    port=8000,
    speed=8.0,
    once=False,
    as_json=False,
    campus=campus_of("carleton"),
)


@pytest.mark.parametrize("as_json", [False, True])
def test_the_code_of_a_person_who_signs_in_is_said_on_a_pipe_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], as_json: bool
) -> None:
    writer = Writer(tmp_path, "mail@campus.example")
    screen = FleetScreen(
        replace(DEMO, as_json=as_json), SharedClock.create(tmp_path / "clock", speed=8.0), Spool(tmp_path)
    )
    writer.send(Mail("sign-in.2.x", "mailroom@campus.example", "Code", "Your code: 12345678", NOW))
    screen.see_mails()
    screen.see_mails()
    told = capsys.readouterr()
    assert (told.err if as_json else told.out).count("Sign-in code for mailroom@campus.example: 12345678") == 1
