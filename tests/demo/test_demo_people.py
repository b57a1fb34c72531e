"""The simulated people of a demonstration read their mails as people do."""

from pathlib import Path

from app.core.mail import Mail
from app.core.mail import Spool as Writer
from app.core.settings import Settings
from demo.people import Spool, sign_in_code
from demo.settings import Demo, default_speed
from protocol.clock import SteppedClock

NOW = SteppedClock().utc()


def demo(tmp_path: Path, low_battery: bool = False) -> Demo:
    return Demo(
        folder=tmp_path,
        door=tmp_path / "door",
        port=8000,
        speed=30.0,
        once=True,
        as_json=True,
        low_battery=low_battery,
        hands_on=False,
    )


def test_a_mail_is_new_once_and_only_sign_in_mails_hold_a_sign_in_code(tmp_path: Path) -> None:
    writer, spool, known = Writer(tmp_path, "mail@campus.example"), Spool(tmp_path), set[str]()
    writer.send(Mail("sign-in.1.x", "ann@campus.example", "Code", "Your code: 12345678", NOW))
    writer.send(Mail("mail.o1.accepted.p1", "ann@campus.example", "Order", "Room 12345678", NOW))
    codes = {name: sign_in_code(mail) for name, mail in spool.new_mails(known)}
    assert codes == {"sign-in.1.x.eml": "12345678", "mail.o1.accepted.p1.eml": None}
    assert list(spool.new_mails(known)) == []


def test_mails_about_an_order_are_counted_by_person_and_kind(tmp_path: Path) -> None:
    writer = Writer(tmp_path, "mail@campus.example")
    for key in ("mail.o1.accepted.p1", "mail.o1.delivered.p1", "mail.o2.accepted.p1", "sign-in.1.x"):
        writer.send(Mail(key, "ann@campus.example", "Subject", "Text", NOW))
    counted = Spool(tmp_path).notices("o1")
    assert counted == {("ann@campus.example", "accepted"): 1, ("ann@campus.example", "delivered"): 1}


def test_the_services_process_is_given_the_very_settings_of_the_demonstration(
    tmp_path: Path, monkeypatch: object
) -> None:
    wanted = demo(tmp_path)
    environment = wanted.service_environment()
    for name, value in environment.items():
        monkeypatch.setenv(name, value)  # type: ignore[attr-defined]
    assert Settings() == wanted.service


def test_only_a_low_battery_needs_another_robot(tmp_path: Path) -> None:
    assert "--config" not in demo(tmp_path).robot_command()
    assert "--config" in demo(tmp_path, low_battery=True).robot_command()


def test_eyes_get_a_slower_demonstration_than_tests_and_hands_a_slower_one_still() -> None:
    assert default_speed(True, False) > default_speed(False, False) > default_speed(False, True)
