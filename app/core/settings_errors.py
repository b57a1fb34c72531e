"""Errors of settings, with the name in the environment and the purpose of each."""

import difflib
from collections.abc import Iterable, Mapping
from typing import Final

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

PREFIX: Final = "CAMPUS_MAIL_"
AS_LIKE: Final = 0.75
"""How alike two names are (difflib's ratio) if one of them is taken for a slip of the pen."""
NOT_SETTINGS: Final = frozenset({"SECRETS_DIR", "ROBOT_CONFIG"})
REMOVED: Final = frozenset(
    {
        *("AGE_LIMIT_S", "ASSUMED_DRIVE_S", "ASSUMED_STAND_S", "CHANGES_PER_PERSON", "CONFIRM_LIFETIME_S"),
        *("DELAYED_AFTER_S", "DETOUR_RATIO", "DIGITS_TRIES_PER_HOST", "ENROLMENT_CODE_LIFETIME_S"),
        *("ENROLMENT_TRIES_PER_HOST", "LINK_LIFETIME_S", "LINK_TRIES_PER_HOST", "NEAR_S"),
        *("NEW_BROWSER_CODES_PER_ADDRESS", "ORDERS_PER_PERSON", "PLANNING_BUDGET_S", "PRIORITY_HEAD_START_S"),
        *("SIGN_IN_CODES_PER_ADDRESS", "SIGN_IN_CODES_PER_HOST", "SIGN_IN_TRIES_PER_HOST"),
        *("STANDING_ORDER_GRACE_S", "TRAFFIC", "WAIT_EXTENSIONS", "WAIT_EXTENSION_S"),
    }
)
"""Settings that were removed (CHANGELOG.md). A value that is set and no longer read is an error: its operator relies
on it."""


def in_sentences(error: ValueError, fields: Mapping[str, FieldInfo]) -> str:
    """One sentence for each setting; what was given is not repeated: it may be a secret."""
    if isinstance(error, ValidationError):
        return " ".join(_sentence(one, fields) for one in error.errors(include_url=False, include_input=False))
    # Of lists only: whatever reads the environment wants JSON and names the field.
    named = next((name for name in fields if f'"{name}"' in str(error)), None)
    return f'{_meant(named, fields)} Write it as JSON: ["one", "another"].' if named else f"{error}."


def _sentence(error: ErrorDetails, fields: Mapping[str, FieldInfo]) -> str:
    wrong = error["msg"].removeprefix("Value error, ").rstrip(".")
    if not error["loc"]:
        return f"{wrong}."
    return f"{_meant(str(error['loc'][0]), fields)} {wrong[:1].upper()}{wrong[1:]}."


def _meant(name: str, fields: Mapping[str, FieldInfo]) -> str:
    described = fields[name].description if name in fields else None
    return f"{PREFIX}{name.upper()} ({(described or 'unknown').rstrip('.')}):"


def removed(given: Iterable[str]) -> list[str]:
    """Return the names that were set and are settings no longer."""
    names = (name.upper() for name in given)
    return sorted(name for name in names if name.startswith(PREFIX) and name.removeprefix(PREFIX) in REMOVED)


def slips(given: Iterable[str], fields: Iterable[str]) -> dict[str, str]:
    """Return settings under a wrong name that looks like a right one: name → the one that was meant.

    Other names are left alone: programs beside the service have variables with this prefix too.
    """
    known = {name.upper() for name in fields} | NOT_SETTINGS
    names = {name.upper().removeprefix(PREFIX) for name in given if name.upper().startswith(PREFIX)}
    alike = {name: difflib.get_close_matches(name, known, 1, AS_LIKE) for name in sorted(names - known)}
    return {f"{PREFIX}{name}": f"{PREFIX}{found[0]}" for name, found in alike.items() if found}
