"""schemathesis finds no answer that the API document does not promise, for any caller.

A short run each time; `make fuzz-api` takes minutes, with every phase and everybody. The stream has tests of its own.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from fastapi import FastAPI
from hypothesis import HealthCheck, Phase, given
from hypothesis import settings as hypothesis_settings
from schemathesis.specs.openapi.checks import positive_data_acceptance

from app.accounts.scopes import Scope
from app.core.settings import Settings
from tests.app import schemathesis_checks
from tests.app.conftest import Mailroom, Served
from tests.app.everybody import Everybody

CHECKOUT = Path(__file__).parents[2]
NEVER_ENDS = "/api/v1/live"
LONG_S = os.environ.get("CAMPUS_MAIL_FUZZ_S", "")
SCRIPTS = ("orders:read notices:write", " ".join(Scope))
"""Tokens of a person with every role: by their scopes."""
WHO = ("stranger", "sender", "dispatcher", "maintainer", *SCRIPTS)
AT_BROWSER = frozenset(WHO[1:4])
QUIET: dict[str, Any] = {
    "max_examples": 2,
    "derandomize": True,
    "suppress_health_check": list(HealthCheck),
    "phases": [Phase.generate],
    "deadline": None,
}


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """Everybody may knock as often as they like: what is limited would hide what is wrong."""
    limits = {name: "1000000 per 1 second" for name in Settings.model_fields if "_per_" in name}
    return settings.model_copy(update=limits)


@pytest.fixture
def everybody(app: FastAPI, mailroom: Mailroom) -> Everybody:
    return Everybody(app, mailroom)


@pytest.fixture
def sessions_to_end(everybody: Everybody) -> Iterator[list[str]]:
    """Sessions of another person, for routes that end sessions."""
    cookies = [everybody.fresh_scene("member").headers["Cookie"].partition("=")[2] for _ in range(20)]
    schemathesis_checks.SESSIONS.extend(cookies)
    yield cookies
    schemathesis_checks.SESSIONS.clear()


def headers_of(everybody: Everybody, who: str) -> dict[str, str]:
    """A script says that it has a cookie, too: the one that schemathesis makes up beside its token is no way in."""
    nothing_else = {"Cookie": "session=none"} if who in SCRIPTS else {}
    return {"Sec-Fetch-Site": "same-origin", **nothing_else, **everybody.scene(who).headers}


# The service's thread in this process draws random numbers too, perhaps just while a case is made.
@pytest.mark.filterwarnings("ignore:Do not use the `random` module:hypothesis.errors.HypothesisDeprecationWarning")
@pytest.mark.nightly
def test_answers_are_as_documented(served: Served, everybody: Everybody, sessions_to_end: list[str]) -> None:
    document = schemathesis.openapi.from_url(f"{served.url}/api/v1/openapi.json")
    operations = [one.ok() for one in document.exclude(path=NEVER_ENDS).get_all_operations()]
    assert len(operations) > 30
    headers = {who: headers_of(everybody, who) for who in WHO}
    for operation in operations:

        @given(case=operation.as_strategy())
        @hypothesis_settings(**QUIET)
        def answers_as_documented(case: Any) -> None:
            for who, own in headers.items():
                # A well-formed wish may still name an unknown post or address: 422, and documented.
                case.call_and_validate(
                    headers={**own, **(schemathesis_checks.own_session(case) if who in AT_BROWSER else {})},
                    excluded_checks=[positive_data_acceptance],
                    additional_checks=[schemathesis_checks.the_code_is_documented],
                )

        answers_as_documented()


@pytest.mark.skipif(not LONG_S, reason="minutes long: make fuzz-api")
@pytest.mark.parametrize("who", WHO)
def test_nothing_is_found_in_minutes_either(
    served: Served, everybody: Everybody, sessions_to_end: list[str], tmp_path: Path, who: str
) -> None:
    headers = headers_of(everybody, who)
    to_end = json.dumps(sessions_to_end if who in AT_BROWSER else [])
    hooks = {"SCHEMATHESIS_HOOKS": "tests.app.schemathesis_checks", "SESSIONS_TO_END": to_end}
    ran = subprocess.run(
        [
            *(sys.executable, "-m", "schemathesis.cli", "run", f"{served.url}/api/v1/openapi.json"),
            *("--exclude-path", NEVER_ENDS, "--exclude-checks", "positive_data_acceptance", "--continue-on-failure"),
            *(part for name, value in headers.items() for part in ("-H", f"{name}: {value}")),
            *("--phases", "examples,coverage,fuzzing,stateful", "--max-time", LONG_S, "--warnings", "off"),
        ],
        cwd=tmp_path,
        env={**os.environ, **hooks, "PYTHONPATH": str(CHECKOUT), "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout[-40_000:] + ran.stderr[-2000:]
    assert "No test cases were generated" not in ran.stdout
