"""Answers become values or exceptions."""

from typing import Any

import httpx
from pydantic import TypeAdapter, ValidationError

from campus_mail_client.errors import NoAnswer, Problem, UnexpectedAnswer, WrongField
from campus_mail_client.problems import BY_CODE
from campus_mail_client.retrying import Retrying, may_repeat_after_answer, may_repeat_after_failure


def pause_after(
    retrying: Retrying, request: httpx.Request, outcome: httpx.Response | httpx.TransportError, tries: int
) -> float | None:
    """Return the pause before the request is sent again; None: it is not."""
    if isinstance(outcome, httpx.TransportError):
        may_repeat, retry_after = may_repeat_after_failure(request.method, request.headers, outcome), ""
    else:
        may_repeat = may_repeat_after_answer(request.method, request.headers, outcome.status_code, code_of(outcome))
        retry_after = outcome.headers.get("Retry-After", "")
    return retrying.pause_s(tries, retry_after) if may_repeat else None


def settled(outcome: httpx.Response | httpx.TransportError, request: httpx.Request, tries: int, kind: Any) -> Any:
    """Return the outcome of the last try. Raises Problem, NoAnswer, UnexpectedAnswer."""
    if isinstance(outcome, httpx.Response):
        return value_of(outcome, kind)
    said = f"{request.method} {request.url.path} got no answer in {tries} tries: {outcome!r}"
    raise NoAnswer(said) from outcome


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
