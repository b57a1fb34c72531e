"""Kinds of values that a setting can have: each refuses what would go wrong only later, and says what is wanted."""

import re
import ssl
from pathlib import Path
from typing import Annotated, Final, Literal
from urllib.parse import urlsplit
from zoneinfo import available_timezones

from limits import parse
from pydantic import AfterValidator, BeforeValidator, Field, IPvAnyNetwork

RATE_LIMITS: Final = {
    "sign_in_codes_per_address": "10 per 15 minutes",  # codes that one browser has mailed to one mail address
    "sign_in_codes_per_host": "60 per 15 minutes",  # codes for one mail address to new browsers at one network address
    "new_browser_codes_per_address": "600 per hour",  # codes for one mail address to all new browsers: bounds guessing
    "sign_in_tries_per_host": "200 per 15 minutes",  # sign-in requests; a browser that has signed in has its own
    "orders_per_person": "600 per hour",
    "changes_per_person": "600 per hour",  # contacts, tokens and the like
    "digits_tries_per_host": "60 per 15 minutes",  # six digits typed from one network address
    "enrolment_tries_per_host": "30 per 15 minutes",  # enrolment codes of robots
    "link_tries_per_host": "300 per 15 minutes",  # links of mails
}
"""The usual rate limits. A host is one network address; `rate_limits` in the settings changes them."""
THIS_MACHINE: Final = frozenset({"localhost", "127.0.0.1", "::1"})


def _capitals(level: object) -> object:
    return level.upper() if isinstance(level, str) else level


def _readable_limit(limit: str) -> str:
    try:
        parse(limit)
    except ValueError:
        raise ValueError(f"{limit!r} is no limit; one is written like 10 per 15 minutes") from None
    return limit


def _with_usual_limits(limits: dict[str, str]) -> dict[str, str]:
    for door, limit in limits.items():
        if door not in RATE_LIMITS:
            raise ValueError(f"there is no rate limit {door!r}; there are {', '.join(RATE_LIMITS)}")
        _readable_limit(limit)
    return RATE_LIMITS | limits


def _known_zone(name: str) -> str:
    if name and name not in available_timezones():
        raise ValueError(f"there is no time zone {name!r}; zones are named like America/Toronto")
    return name


def hours_between(hours: str) -> range:
    """The whole hours of a day that are meant by 8-18: from eight until six in the evening."""
    first, _, end = hours.partition("-")
    return range(int(first), int(end))


def _office_hours(hours: str) -> str:
    if not re.fullmatch(r"\d{1,2}-\d{1,2}", hours) or not hours_between(hours) or hours_between(hours).stop > 24:
        raise ValueError(f"{hours!r} are no office hours; whole hours of one day are wanted, such as 8-18")
    return hours


def _lower_case(domains: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(domain.lower().removeprefix("@") for domain in domains)


def _whole_address(address: str) -> str:
    url = urlsplit(address)
    if address and not (url.scheme in {"http", "https"} and url.hostname):
        raise ValueError("a whole address is wanted, such as https://mail.campus.example")
    return address


def _https_elsewhere(address: str) -> str:
    url = urlsplit(address)
    if address and url.scheme != "https" and url.hostname not in THIS_MACHINE:
        raise ValueError("the address begins with https://")
    return address


def _mail_address(address: str) -> str:
    if not re.fullmatch(r"[^@\s<>]+@[^@\s<>]+", address):
        raise ValueError("a mail address is wanted, such as mail@campus.example")
    return address


def _contact(contact: str) -> str:
    if contact and not contact.startswith(("mailto:", "https://")):
        raise ValueError("it begins with mailto: or https://")
    return contact


def _readable_authorities(file: Path | None) -> Path | None:
    if file is None:
        return None
    try:
        ssl.create_default_context(cafile=file)
    except OSError as error:  # SSLError is one
        raise ValueError(f"{file} cannot be used: {error.strerror or error}") from None
    return file


def _not_everyone(networks: tuple[IPvAnyNetwork, ...]) -> tuple[IPvAnyNetwork, ...]:
    if any(network.prefixlen == 0 for network in networks):
        raise ValueError("with all addresses in it every client could choose the address it seems to come from")
    return networks


def _whole_fingerprints(fingerprints: tuple[str, ...]) -> tuple[str, ...]:
    for one in fingerprints:
        if not re.fullmatch(r"[0-9A-F]{2}(:[0-9A-F]{2}){31}", one):
            raise ValueError(f"{one!r} is no SHA-256 fingerprint; one is 32 pairs of hex digits: AB:CD:…")
    return fingerprints


def android_package(name: str) -> str:
    """Return the name of an Android app, or raise ValueError where Android would refuse it; empty is none."""
    if name and not re.fullmatch(r"[A-Za-z]\w*(\.[A-Za-z]\w*)+", name, re.ASCII):
        raise ValueError(f"{name!r} is no name of an Android app; one looks like example.campus.mail")
    return name


Ports = Annotated[tuple[Annotated[int, Field(ge=1, le=65535)], ...], Field(min_length=1)]
Networks = tuple[IPvAnyNetwork, ...]
Proxies = Annotated[Networks, AfterValidator(_not_everyone)]
SmtpTls = Literal["starttls", "tls", "none"]
Language = Literal["en", "fr"]
LogLevel = Annotated[Literal["DEBUG", "INFO", "WARNING", "ERROR"], BeforeValidator(_capitals)]
RateLimitsByDoor = Annotated[dict[str, str], AfterValidator(_with_usual_limits)]
Zone = Annotated[str, AfterValidator(_known_zone)]
OfficeHours = Annotated[str, AfterValidator(_office_hours)]
Domains = Annotated[tuple[str, ...], AfterValidator(_lower_case)]
AndroidPackage = Annotated[str, AfterValidator(android_package)]
Fingerprints = Annotated[tuple[str, ...], AfterValidator(_whole_fingerprints)]
WholeAddress = Annotated[str, AfterValidator(_whole_address)]
Issuer = Annotated[str, AfterValidator(_https_elsewhere)]
MailAddress = Annotated[str, AfterValidator(_mail_address)]
Contact = Annotated[str, AfterValidator(_contact)]
Authorities = Annotated[Path | None, AfterValidator(_readable_authorities)]
