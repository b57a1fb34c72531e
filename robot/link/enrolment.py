"""A robot becomes known to a service: its secrets into files of their own, name and address into the settings."""

import os
import re
import ssl
import tempfile
from pathlib import Path
from urllib.parse import urlsplit

import httpx

from robot.core.config import ConfigError
from robot.core.durable_file import replace

LONGEST_TOKEN = 512
LIMIT_S = 10.0
LINK = "/robots/link"
_TOKEN = re.compile(r"[\x21-\x7e]+")


def checked_token(text: str) -> str:
    """Without the line's end. Raises ConfigError when it cannot be one: nothing, or more than one word."""
    token = text.strip()
    if not _TOKEN.fullmatch(token) or len(token) > LONGEST_TOKEN:
        way_out = "`python -m app robots enrol NAME --token` at the service prints it, once."
        raise ConfigError("the token", "token", "is one word of printable characters", way_out)
    return token


def token_for(code: str, name: str, link: str, public_key: str) -> str:
    """Exchange a one-time code for this robot's token. Raises ConfigError with the service's own sentence."""
    wish = {"name": name, "code": code.strip(), "public_key": public_key}
    try:
        answer = httpx.post(address(link), json=wish, timeout=LIMIT_S, trust_env=False, verify=trusted())
        told = answer.json()
    except (httpx.HTTPError, ValueError) as error:
        way_out = "Check the network, the address and the certificate. The code may still be good."
        why = " ".join(str(error).split())[:200] or type(error).__name__
        raise ConfigError(link, "server", f"cannot be asked ({why})", way_out) from None
    if answer.status_code != httpx.codes.CREATED:
        way_out = "`python -m app robots enrol NAME` at the service makes a new code."
        raise ConfigError("the service", "code", f"refuses it: {told.get('detail', answer.status_code)}", way_out)
    return checked_token(str(told["token"]))


def trusted() -> ssl.SSLContext:
    """The authorities that this computer trusts, as for the link itself: a campus may have one of its own
    (SSL_CERT_FILE, or the system's store). Httpx would know the public ones alone."""
    return ssl.create_default_context()


def address(link: str) -> str:
    """Beside the robot link: wss://host/api/v1/robots/link → https://host/api/v1/robots/enrol."""
    parts = urlsplit(link)
    scheme = "https" if parts.scheme == "wss" else "http"
    return f"{scheme}://{parts.netloc}{parts.path.removesuffix(LINK)}/robots/enrol"


def keep_secret(path: Path, text: str, key: str) -> None:
    """Write it, readable by its owner alone from the first moment. `key` is its setting. Raises ConfigError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)  # mkstemp makes it 0600
        with os.fdopen(handle, "w", encoding="ascii") as file:
            file.write(f"{text.strip()}\n")
            file.flush()
            os.fsync(file.fileno())
        replace(Path(name), path)
    except OSError as error:
        way_out = "Run this as the robot's user: sudo -u campus-mail …"
        raise ConfigError(str(path), key, f"cannot be written: {error.strerror}", way_out) from None
