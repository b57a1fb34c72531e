"""Answers become values or exceptions."""

from typing import Any, TypeVar

import httpx
from pydantic import TypeAdapter, ValidationError

from campus_mail_client.errors import Problem, UnexpectedAnswer, WrongField
from campus_mail_client.problems import BY_CODE

Value = TypeVar("Value")


def value_of(answer: httpx.Response, kind: Any) -> Any:
    """The body as `kind`: a model, `bytes`, or None for no body. Raises Problem, UnexpectedAnswer."""
    if answer.is_error:
        raise problem_of(answer)
    if kind is None:
        return None
    if kind is bytes:
        return answer.content
    try:
        return TypeAdapter(kind).validate_json(answer.content)
    except ValidationError as error:
        raise UnexpectedAnswer(f"{answer.request.method} {answer.request.url.path}: {error}") from error


def problem_of(answer: httpx.Response) -> Problem | UnexpectedAnswer:
    """The exception for an error answer that has been read."""
    said = _said(answer)
    if said is None:
        return UnexpectedAnswer(f"{answer.status_code} from {answer.request.url.path}, and not by Campus Mail.")
    errors = tuple(WrongField(str(one["field"]), str(one["message"])) for one in said.get("errors") or ())
    retry_after = answer.headers.get("Retry-After", "")
    code = str(said["code"])
    return BY_CODE.get(code, Problem)(
        str(said.get("detail", "")), answer.status_code, code, errors, float(retry_after) if retry_after else None
    )


def code_of(answer: httpx.Response) -> str:
    """The `code` of an error answer; empty if it has none."""
    said = _said(answer) if answer.is_error else None
    return str(said["code"]) if said else ""


def _said(answer: httpx.Response) -> dict[str, Any] | None:
    try:
        said = answer.json()
    except ValueError:
        return None
    return said if isinstance(said, dict) and "code" in said else None
