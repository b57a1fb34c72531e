"""Settings come from the environment, secrets from files; what cannot be used is said in a sentence, with a way out."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.__main__ import app as commands
from app.core.errors import StartError
from app.core.settings import Settings, load_settings


def test_settings_come_from_the_environment_and_secrets_from_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "campus_mail_database_url").write_text("postgresql+asyncpg://mail:secret@db/mail")
    monkeypatch.setenv("CAMPUS_MAIL_SECRETS_DIR", str(tmp_path))
    monkeypatch.setenv("CAMPUS_MAIL_ALLOWED_DOMAINS", '["Campus.Example", "@other.example"]')
    settings = load_settings()
    assert settings.url_of_database == "postgresql+asyncpg://mail:secret@db/mail"
    assert settings.allowed_domains == ("campus.example", "other.example")


@pytest.mark.parametrize(
    ("name", "value", "wanted"),
    [
        ("PORT", "many", "TCP port to listen on"),
        ("PORT", "99999", "less than or equal to 65535"),
        ("ALLOWED_DOMAINS", "campus.example", "Write it as JSON"),
        ("TIME_ZONE", "Mars/Olympus", "America/Toronto"),
        ("OFFICE_HOURS", "18-8", "such as 8-18"),
        ("LOG_LEVEL", "LOUD", "'WARNING'"),
        ("DEFAULT_LANGUAGE", "de", "'fr'"),
        ("PUBLIC_URL", "mail.campus.example", "a whole address is wanted, such as https://"),
        ("MAIL_FROM", "the mailroom", "a mail address is wanted"),
        ("PUSH_CONTACT", "me", "mailto:"),
        ("SMTP_CA_FILE", "/nowhere/ca.pem", "No such file"),
        ("OIDC_ISSUER", "https://login.campus.example", "oidc_client_id"),
        ("RATE_LIMITS", '{"orders_per_person": "lots"}', "10 per 15 minutes"),
        ("RATE_LIMITS", '{"orders_per_hour": "1 per hour"}', "there is no rate limit 'orders_per_hour'"),
        ("ANDROID_PACKAGE", "mail", "one looks like example.campus.mail"),
        ("ANDROID_FINGERPRINTS", '["AB:CD"]', "32 pairs of hex digits"),
        ("TRUSTED_PROXIES", '["0.0.0.0/0"]', "every client could choose"),
        ("WEBHOOK_SECRET", "short", ""),
    ],
)
def test_a_setting_that_cannot_be_used_is_named_and_what_is_wanted_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, value: str, wanted: str
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))
    monkeypatch.setenv(f"CAMPUS_MAIL_{name}", value)
    if name == "WEBHOOK_SECRET":
        monkeypatch.setenv("CAMPUS_MAIL_WEBHOOK_URL", "http://127.0.0.1:9")
    ran = CliRunner().invoke(commands, ["serve", "--port", "0"])
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert name.lower() in ran.stderr.lower()
    assert wanted.lower() in ran.stderr.lower()
    assert len(ran.stderr.splitlines()) == 1, "a sentence"
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize(("slip", "meant"), [("PROT", "PORT"), ("PUBLIC_ULR", "PUBLIC_URL"), ("SMTPHOST", "SMTP_HOST")])
def test_a_setting_under_a_name_that_there_is_not_is_not_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, slip: str, meant: str
) -> None:
    monkeypatch.setenv(f"CAMPUS_MAIL_{slip}", "1")
    with pytest.raises(StartError, match=f"no setting CAMPUS_MAIL_{slip}. Did you mean CAMPUS_MAIL_{meant}"):
        load_settings()
    monkeypatch.delenv(f"CAMPUS_MAIL_{slip}")
    (tmp_path / f"campus_mail_{slip.lower()}").write_text("1")
    monkeypatch.setenv("CAMPUS_MAIL_SECRETS_DIR", str(tmp_path))
    with pytest.raises(StartError, match=f"Did you mean CAMPUS_MAIL_{meant}"):
        load_settings()


def test_a_setting_of_an_older_version_is_refused_with_a_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_ORDERS_PER_PERSON", "10 per hour")
    with pytest.raises(
        StartError, match=r"no setting CAMPUS_MAIL_ORDERS_PER_PERSON any more: unset it, and see CHANGELOG"
    ):
        load_settings()


def test_variables_of_other_programs_beside_the_service_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("URL", "TOKEN", "ROBOT_CONFIG"):
        monkeypatch.setenv(f"CAMPUS_MAIL_{name}", "something")
    assert load_settings().port == Settings().port


def test_a_folder_of_secrets_that_is_not_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_SECRETS_DIR", "/nowhere/secrets")
    with pytest.raises(StartError, match="/nowhere/secrets cannot be read: No such file or directory"):
        load_settings()


def test_secrets_come_as_systemd_hands_them_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "campus_mail_metrics_token").write_text("of the unit\n")
    monkeypatch.setenv("CREDENTIALS_DIRECTORY", str(tmp_path))
    assert load_settings().metrics_token.get_secret_value() == "of the unit"
    monkeypatch.setenv("CAMPUS_MAIL_SECRETS_DIR", str(tmp_path.parent))
    assert load_settings().metrics_token.get_secret_value() == "", "a folder of our own goes first"
