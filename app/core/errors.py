"""Errors by name, and their answers: RFC 9457 problem documents with a stable `code`.

ServiceError                 a request that cannot be met: status, code, a sentence
├── BadRequest (400)         the request contradicts itself
├── NotSignedIn (401)        the request is not signed in, or the session has ended
├── Forbidden (403)          signed in, but not allowed to
├── NotFound (404)           not there, or not for this person to see
├── Conflict (409)           the state does not allow it now
├── PreconditionFailed (412) changed since it was read
├── Unprocessable (422)      well formed, yet not to be fulfilled
└── TooManyRequests (429)    slower, please
StartError                   the service cannot start; a person at a terminal reads it

Features derive their own from these: `app.orders.errors`, `app.accounts.errors`.
"""

import inspect
from collections.abc import Mapping
from http import HTTPStatus
from typing import Any, ClassVar, Final

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel
from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError
from sqlalchemy.exc import TimeoutError as WaitedTooLong
from starlette.exceptions import HTTPException
from starlette.routing import Match

from protocol.one_line import ONE_LINE

PROBLEM_JSON = "application/problem+json"
TRY_AGAIN_S: Final = 5
DATABASE_AWAY: Final = (OperationalError, InterfaceError, WaitedTooLong)
"""Gone, locked, or full: over by itself or by the operator's hand."""
METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE")
log = structlog.get_logger(__name__)


class ServiceError(Exception):
    """Answers the request with `status`; `code` never changes, the sentence may."""

    status: ClassVar[int] = 500
    code: ClassVar[str] = "service_error"

    def __init__(self, sentence: str, headers: Mapping[str, str] | None = None) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.headers = dict(headers or {})


class BadRequest(ServiceError):
    """The request contradicts itself."""

    status = 400
    code = "bad_request"


class NotSignedIn(ServiceError):
    """No session, or one that has ended or was revoked."""

    status = 401
    code = "not_signed_in"


class Forbidden(ServiceError):
    """Known who asks; they may not."""

    status = 403
    code = "forbidden"


class NotFound(ServiceError):
    """Not there; also what is there but not for this person to see, so that it cannot be probed for."""

    status = 404
    code = "not_found"


class Conflict(ServiceError):
    """The present state does not allow it."""

    status = 409
    code = "conflict"


class PreconditionFailed(ServiceError):
    """If-Match names an older version: read it again first."""

    status = 412
    code = "precondition_failed"


class Unprocessable(ServiceError):
    """Well formed, yet it cannot be fulfilled."""

    status = 422
    code = "unprocessable"


class TooManyRequests(ServiceError):
    """More often than is allowed; Retry-After says when to come back."""

    status = 429
    code = "too_many_requests"


class StartError(Exception):
    """The service cannot start. Says what is wrong and the way out; the command ends with exit code 2."""


class Refused(StartError):
    """A command will not do this; the sentence says why and what to do instead."""


class FieldProblem(BaseModel):
    """One field that does not fit; its value is not repeated, since it may be a secret."""

    field: str
    message: str


class Problem(BaseModel):
    """Every error answer (RFC 9457). `code` is for programs, `detail` for people."""

    type: str
    title: str
    status: int
    detail: str
    code: str
    errors: list[FieldProblem] | None = None


CODES_OF_STATUS: Final[Mapping[int, str]] = {
    400: "malformed_body",
    404: "not_found",
    405: "method_not_allowed",
    413: "too_large",
    415: "unsupported_media_type",
}

GENERAL: Final[Mapping[str, tuple[int, str]]] = {
    "malformed_body": (400, "The body cannot be read as JSON."),
    "method_not_allowed": (405, "The path is there; Allow says what can be done with it."),
    "too_large": (413, "The body is larger than 64 KiB."),
    "unsupported_media_type": (415, "Bodies are taken as application/json alone."),
    "invalid_request": (422, "A field of the body, the path, the query or a header does not fit; `errors` names it."),
    "http_error": (500, "Another refusal of the web server, by its status."),
    "database_away": (503, "The database is gone, locked or its disk full; Retry-After says when to try again."),
    "unforeseen": (500, "A mistake of the service; it is in its log."),
    "not_ready": (503, "The service should get no requests now; `detail` says why."),
}
"""The codes that no error class has, because they are not raised by name."""


def problems(*what: int | type[ServiceError]) -> dict[int | str, dict[str, Any]]:
    """The error answers of one route, for `responses=`: the errors that it raises, or the number of a status.

    What holds for every route (who may ask, whether a body can be read) is added to the document by itself.
    """
    codes: dict[int, dict[str, str]] = {one: {} for one in what if isinstance(one, int)}
    for one in what:
        if not isinstance(one, int):
            codes.setdefault(one.status, {})[one.code] = meaning(one)
    return {status: described_problem(status, meanings) for status, meanings in codes.items()}


def answering(status: int, *headers: str) -> dict[int | str, dict[str, Any]]:
    """The headers that go with an answer, for `responses=`; what they mean is in `app.http.api_document`."""
    return {status: {"headers": {name: {} for name in headers}}}


def described_problem(status: int, meanings: Mapping[str, str]) -> dict[str, Any]:
    """One error answer as the OpenAPI document shows it; `x-codes` says which codes it can carry."""
    said = "".join(f"\n- `{code}`: {sentence}" for code, sentence in meanings.items())
    return {
        "description": HTTPStatus(status).phrase + said,
        "content": {PROBLEM_JSON: {"schema": {"$ref": "#/components/schemas/Problem"}}},
        "x-codes": dict(meanings),
    }


def meaning(error: type[ServiceError]) -> str:
    """The first paragraph of the error's docstring."""
    return " ".join(inspect.cleandoc(error.__doc__ or "").split("\n\n")[0].split())


def problem_answer(
    status: int,
    code: str,
    detail: str,
    headers: Mapping[str, str] | None = None,
    errors: list[FieldProblem] | None = None,
) -> JSONResponse:
    """A problem document as an answer."""
    problem = Problem(
        type=f"urn:campus-mail:problem:{code}",
        title=HTTPStatus(status).phrase,
        status=status,
        detail=detail,
        code=code,
        errors=errors,
    )
    content = problem.model_dump(exclude_none=True)
    return JSONResponse(content, status, dict(headers or {}), media_type=PROBLEM_JSON)


def add_error_answers(app: FastAPI) -> None:
    """Make every error of `app` a problem document: ours, FastAPI's, Starlette's and the unforeseen."""
    app.add_exception_handler(ServiceError, _answer_service_error)
    app.add_exception_handler(RequestValidationError, _answer_invalid)
    app.add_exception_handler(HTTPException, _answer_http)
    for away in DATABASE_AWAY:
        app.add_exception_handler(away, _answer_database)
    app.add_exception_handler(Exception, _answer_unforeseen)


async def _answer_service_error(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, ServiceError)  # noqa: S101  # registered for this class alone
    # RFC 9110 wants to be told how a caller can prove who it is; browsers do not ask for a bearer's token.
    how = {"WWW-Authenticate": "Bearer"} if error.status == HTTPStatus.UNAUTHORIZED else {}
    return problem_answer(error.status, error.code, error.sentence, {**how, **error.headers})


async def _answer_database(request: Request, error: Exception) -> JSONResponse:
    """Not the caller's fault, and over by itself or by the operator's hand: worth another try."""
    why = error.orig if isinstance(error, DBAPIError) else error
    log.error("database_away", path=request.url.path, why=str(why))
    sentence = "The database cannot be used just now, and this may not have been done. Try again in a moment."
    return problem_answer(503, "database_away", sentence, {"Retry-After": str(TRY_AGAIN_S)})


async def _answer_invalid(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)  # noqa: S101  # registered for this class alone
    if unreadable := _what_is_unreadable(error):
        return unreadable
    fields = [FieldProblem(field=_place(one["loc"]), message=_message(one)) for one in error.errors()]
    detail = "; ".join(f"{one.field}: {one.message}" for one in fields)
    return problem_answer(422, "invalid_request", detail, errors=fields)


def _what_is_unreadable(error: RequestValidationError) -> JSONResponse | None:
    """A body of another type, or one that is no JSON: nothing in it was looked at."""
    if any(one["type"] == "json_invalid" for one in error.errors()):
        return problem_answer(400, "malformed_body", "The body is no JSON.")
    if isinstance(error.body, bytes):  # left as it came, because its type is not JSON
        return problem_answer(415, "unsupported_media_type", "Send the body as application/json.")
    return None


def _message(error: Any) -> str:
    """Our own words where a person could not read pydantic's: a pattern of invisible characters."""
    is_a_line = error["type"] == "string_pattern_mismatch" and error["ctx"]["pattern"] == ONE_LINE
    return "Must be one line without invisible characters" if is_a_line else str(error["msg"])


def _place(loc: tuple[Any, ...]) -> str:
    return ".".join(str(part) for part in loc if part != "body") or "body"


async def _answer_http(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)  # noqa: S101  # registered for this class alone
    code = CODES_OF_STATUS.get(error.status_code, "http_error")
    allowed = _allowed(request) if error.status_code == HTTPStatus.METHOD_NOT_ALLOWED else ""
    return problem_answer(error.status_code, code, str(error.detail), {"Allow": allowed} if allowed else error.headers)


def _allowed(request: Request) -> str:
    """Everything that can be done with a path: the router itself names the methods of one route alone. What stands in
    the document as it is (`/robots/enrol`) is nothing else besides (`/robots/{name}`)."""
    if documented := request.app.openapi()["paths"].get(request.url.path):
        return ", ".join(method for method in METHODS if method.lower() in documented)
    routes = request.app.router.routes
    scopes = {method: {**request.scope, "method": method} for method in METHODS}
    return ", ".join(m for m, scope in scopes.items() if any(r.matches(scope)[0] is Match.FULL for r in routes))


async def _answer_unforeseen(request: Request, error: Exception) -> JSONResponse:
    log.error("unforeseen", path=request.url.path, error=type(error).__name__, exc_info=error)
    return problem_answer(500, "unforeseen", "Something went wrong here. It is in the log; please try again.")
