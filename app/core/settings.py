"""Everything that can be set, each with a default that works. Environment: CAMPUS_MAIL_<NAME in capitals>.

Secrets come from files: the server key lives in its own file, and any setting may be given as a file
`campus_mail_<name>` in the folder that CAMPUS_MAIL_SECRETS_DIR names (a database URL with a password, say).
"""

import os
from collections.abc import Iterable
from ipaddress import IPv4Network
from pathlib import Path
from typing import Annotated, Final, Literal, Self
from zoneinfo import ZoneInfo

from pydantic import Field, SecretStr, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from app.core.errors import StartError
from app.core.parts import part
from app.core.setting_kinds import (
    THIS_MACHINE,
    AndroidPackage,
    Authorities,
    Contact,
    Domains,
    Fingerprints,
    Issuer,
    Language,
    LogLevel,
    MailAddress,
    Networks,
    OfficeHours,
    Ports,
    Proxies,
    RateLimitsByDoor,
    SmtpTls,
    WholeAddress,
    Zone,
    hours_between,
)
from app.core.settings_errors import in_sentences, removed, slips
from app.core.trusted_clock import TrustedClock
from maps import CampusMap, CampusMapError, find_map
from protocol.clock import Clock, SharedClock

_INSTALLED = Path(__file__).parents[1] / "data"
ROOT = _INSTALLED if _INSTALLED.is_dir() else Path(__file__).parents[2]
"""Where pages and migrations lie: `app/data` where a wheel was installed, else the checkout (`.ci/wheel.py`)."""
SMTP_PORTS: Final = {"starttls": 587, "tls": 465, "none": 25}


class Settings(BaseSettings):
    """The service's settings; `docs/reference/settings.md` lists them for people."""

    # What does not fit is not repeated: it may be a secret.
    model_config = SettingsConfigDict(
        env_prefix="CAMPUS_MAIL_", frozen=True, extra="forbid", validate_default=True, hide_input_in_errors=True
    )

    host: str = Field("127.0.0.1", description="Address to listen on.")
    port: int = Field(8000, ge=0, le=65535, description="TCP port to listen on; 0 takes a free one.")
    tls_cert: Path | None = Field(
        None, description="Certificate chain (PEM) to serve https and wss with; with tls_key."
    )
    tls_key: Path | None = Field(None, description="Private key of the certificate (PEM).")
    trusted_proxies: Proxies = Field(
        (IPv4Network("127.0.0.1/32"),),
        description="Networks of proxies whose X-Forwarded-For and X-Forwarded-Proto are believed (JSON list).",
    )
    data: Path = Field(Path("var/service"), description="Folder for database, keys and spool; made with mode 0700.")
    database_url: str = Field("", description="SQLAlchemy URL; empty means SQLite in the data folder.")
    database_wait_s: float = Field(
        10, gt=0, description="How long a request may wait for the database in all; after that it is answered 503."
    )
    request_within_s: float = Field(
        30,
        gt=0,
        description="How long a client may take for its TLS handshake, the head of a request and its body; real time.",
    )
    spool: Path | None = Field(None, description="Folder for .eml files; default: `spool` in the data folder.")
    server_key_file: Path | None = Field(
        None,
        description="File with the key that hand-over codes derive from; default: `server.key` in the data folder.",
    )
    pages: Path = Field(ROOT / "web", description="Folder of the pages.")
    android_package: AndroidPackage = Field(
        "", description="Name of an Android app that opens these pages as its own, as `make android` builds it."
    )
    android_fingerprints: Fingerprints = Field(
        (), description="SHA-256 fingerprints of the certificates that sign it (JSON list), as AB:CD:…"
    )
    map: str = Field("test_track", description="Campus map: the name of a built-in one, or a file.")
    public_url: WholeAddress = Field(
        "", description="Address of the pages in mails, such as https://mail.campus.example."
    )
    allowed_domains: Domains = Field(
        ("campus.example",), description="Mail domains whose people may sign in and be sent mail (JSON list)."
    )
    allow_outside_recipients: bool = Field(
        False, description="Whether mail may be sent to people of other domains; they follow it by the link they get."
    )
    mail_from: MailAddress = Field("mail@campus.example", description="Sender of the service's mails.")
    smtp_host: str = Field("", description="Mail server; empty: mails are files in the spool folder.")
    smtp_port: int = Field(0, ge=0, le=65535, description="Its port; 0: the usual one, 587, 465 or 25 by smtp_tls.")
    smtp_tls: SmtpTls = Field("starttls", description="starttls, tls, or none for a server on this machine.")
    smtp_user: str = Field("", description="Account at the mail server; empty: none is needed.")
    smtp_password: SecretStr = Field(SecretStr(""), description="Its password; give it as a file.")
    smtp_ca_file: Authorities = Field(None, description="Authorities to trust, if not the system's own (PEM).")
    smtp_timeout_s: float = Field(30, gt=0, description="How long the mail server may take for each answer.")
    push_key_file: Path | None = Field(
        None, description="File with the key of Web Push (VAPID); default: `push.key` in the data folder."
    )
    push_contact: Contact = Field("", description="Whom a push service may write to, as mailto:…; default: mail_from.")
    webhook_url: WholeAddress = Field("", description="Address that gets every notice, for whichever person it is.")
    webhook_secret: SecretStr = Field(
        SecretStr(""), description="What signs them: at least 24 characters; give it as a file."
    )
    outside_ports: Ports = Field(
        (443,), description="Ports of the addresses that people give for pushes and webhooks (JSON list)."
    )
    outside_refused_networks: Networks = Field(
        (), description="Public networks that such addresses may not be in, such as the campus's own (JSON list)."
    )
    default_language: Language = Field("en", description="Language of people who have not chosen one: en or fr.")
    time_zone: Zone = Field(
        "", description="Zone of times in mails, such as America/Toronto; empty: the machine's own."
    )
    sign_in_code_lifetime_s: float = Field(600, gt=0, description="How long a mailed sign-in code is good for.")
    session_lifetime_s: float = Field(30 * 86400, gt=0, description="How long a browser stays signed in.")
    session_check_s: float = Field(
        30, gt=0, description="How often an open event stream asks whether its person is still signed in; real time."
    )
    handover_code_lifetime_s: float = Field(7 * 86400, gt=0, description="How long the codes of an order are good for.")
    oidc_issuer: Issuer = Field(
        "", description="Issuer of the campus's OpenID Connect sign-in, such as https://login.campus.example."
    )
    oidc_client_id: str = Field("", description="What this service is called there.")
    oidc_client_secret: SecretStr = Field(SecretStr(""), description="Its secret there; give it as a file.")
    rate_limits: RateLimitsByDoor = Field(
        {},
        description="Rate limits that differ from the usual ones (JSON object), such as "
        '{"orders_per_person": "60 per hour"}; `app/core/setting_kinds.py` lists them.',
    )
    streams_per_person: int = Field(20, gt=0, description="Event streams that one person may have open at a time.")
    assumed_speed_m_s: float = Field(0.15, gt=0, description="Assumed mean speed of a robot, for arrival windows.")
    assumed_handover_s: float = Field(120, ge=0, description="Assumed time of one hand-over, for arrival windows.")
    office_hours: OfficeHours = Field(
        "8-18", description="When people are in their offices from Monday to Friday and come sooner, such as 8-18."
    )
    wait_limit_s: float = Field(600, gt=0, description="How long a robot waits for a person at a stop.")
    undelivered_to: Literal["sender", "mailroom"] = Field(
        "sender",
        description="Where undelivered mail goes: sender, or the mailroom of the map. Robots are set alike.",
    )
    queue_limit_s: float = Field(86400, gt=0, description="An order that no robot has fetched for so long expires.")
    vanished_after_s: float = Field(
        900, gt=0, description="A robot that was not heard of for so long is gone round, and people are told."
    )
    robot_capacity: int = Field(2, ge=1, description="How many items a robot carries at once.")
    metrics_token: SecretStr = Field(
        SecretStr(""), description="Token that opens /metrics to other machines; empty: this machine alone. A file."
    )
    keep_orders_days: float = Field(
        400, ge=1, description="How long ended orders keep names and addresses; afterwards they are anonymous records."
    )
    keep_telemetry_days: float = Field(
        30, ge=1, description="How long messages of and to robots, sendings and mails in the spool are kept."
    )
    keep_traces_days: float = Field(
        7, ge=1, description="How long codes, sessions, tokens and links are kept after they have ended."
    )
    clock_settles_s: float = Field(
        600, gt=0, description="How long a leap of the machine's clock has to last until it is believed; real time."
    )
    clock_file: Path | None = Field(None, description="Shared scaled clock of a demonstration; default: real time.")
    demo_door: Path | None = Field(
        None, description="Door of a simulated robot, or a folder of several' doors; set by demonstrations alone."
    )
    log_level: LogLevel = Field("INFO", description="DEBUG, INFO, WARNING or ERROR.")

    @model_validator(mode="after")
    def _secrets_travel_encrypted(self) -> Self:
        if self.smtp_host and self.smtp_tls == "none" and self.smtp_host not in THIS_MACHINE:
            raise ValueError(f"smtp_tls is none, but {self.smtp_host} is another machine: set it to starttls or tls")
        if self.webhook_url and len(self.webhook_secret.get_secret_value()) < 24:
            raise ValueError("webhook_url needs a webhook_secret of at least 24 characters")
        return self

    @model_validator(mode="after")
    def _a_demonstration_stays_on_this_machine(self) -> Self:
        if self.demo_door is not None and self.host not in THIS_MACHINE:
            raise ValueError(
                f"demo_door is for demonstrations, whose links sign in without a code: host must be 127.0.0.1, "
                f"not {self.host}"
            )
        return self

    @model_validator(mode="after")
    def _the_providers_client_is_named(self) -> Self:
        if bool(self.oidc_issuer) != bool(self.oidc_client_id):
            raise ValueError("oidc_issuer and oidc_client_id go together: set both, or neither")
        return self

    @property
    def smtp_port_or_usual(self) -> int:
        return self.smtp_port or SMTP_PORTS[self.smtp_tls]

    @property
    def push_contact_or_usual(self) -> str:
        return self.push_contact or f"mailto:{self.mail_from}"

    @property
    def push_key_path(self) -> Path:
        return self.push_key_file or self.data / "push.key"

    @property
    def url_of_database(self) -> str:
        return self.database_url or f"sqlite:///{(self.data / 'campus-mail.sqlite').resolve()}"

    @property
    def zone(self) -> ZoneInfo | None:
        return ZoneInfo(self.time_zone) if self.time_zone else None

    @property
    def hours_of_offices(self) -> range:
        return hours_between(self.office_hours)

    @property
    def spool_folder(self) -> Path:
        return self.spool or self.data / "spool"

    @property
    def waiting_mails_folder(self) -> Path:
        return self.data / "waiting-mails"

    @property
    def server_key_path(self) -> Path:
        return self.server_key_file or self.data / "server.key"


def load_settings() -> Settings:
    """Settings from the environment and the folder of secrets. Raises StartError."""
    # Without a folder of our own: the one in which systemd hands over what LoadCredential= names.
    secrets_dir = os.environ.get("CAMPUS_MAIL_SECRETS_DIR") or os.environ.get("CREDENTIALS_DIRECTORY")
    _refuse_slips(os.environ)
    try:
        if secrets_dir:
            _refuse_slips(file.name for file in Path(secrets_dir).iterdir())
        return Settings(_secrets_dir=secrets_dir)
    except OSError as error:
        raise StartError(
            f"The folder of secrets {secrets_dir} cannot be read: {error.strerror}. "
            "Name one that this user can read, or unset CAMPUS_MAIL_SECRETS_DIR."
        ) from None
    except ValueError as error:
        raise StartError(f"The settings cannot be used. {in_sentences(error, Settings.model_fields)}") from None


def _refuse_slips(given: Iterable[str]) -> None:
    """Refuse a setting that is not read: its operator relies on it."""
    given = tuple(given)
    for name in removed(given):
        raise StartError(f"There is no setting {name} any more: unset it, and see CHANGELOG.md.")
    for name, meant in slips(given, Settings.model_fields).items():
        raise StartError(f"There is no setting {name}. Did you mean {meant}?")


def open_clock(settings: Settings) -> Clock:
    """The machine's clock without its leaps, or the shared one of a demonstration. Raises StartError."""
    if settings.clock_file is None:
        return TrustedClock(settings.clock_settles_s)
    try:
        return SharedClock(settings.clock_file)
    except OSError as error:
        raise StartError(f"The clock file {settings.clock_file} cannot be opened: {error}.") from error


def open_map(settings: Settings) -> CampusMap:
    """The campus. Raises StartError."""
    try:
        return find_map(settings.map)
    except CampusMapError as error:
        raise StartError(f"The map cannot be used. {error}") from error


def make_data_folder(settings: Settings) -> None:
    """The data folder holds keys and names: other users of the machine may not read it. Raises StartError."""
    try:
        settings.data.mkdir(parents=True, exist_ok=True)
        settings.data.chmod(0o700)
    except OSError as error:
        raise StartError(
            f"The data folder {settings.data} cannot be made: {error.strerror}. Set CAMPUS_MAIL_DATA to one that "
            "this user may write to."
        ) from error


SettingsDep = Annotated[Settings, part(Settings)]
ClockDep = Annotated[Clock, part(Clock)]
CampusDep = Annotated[CampusMap, part(CampusMap)]
