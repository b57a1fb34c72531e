"""The OpenAPI document: what FastAPI finds in the routes, and what holds for all of them.

The name of a route's function is its `operationId`, and so the name of the client's method; its docstring is the
description, the first sentence of it the summary. Error answers list their codes; what headers and tags mean stands in
the tables here, examples in `app.http.api_examples`.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from fastapi import FastAPI
from fastapi.routing import APIRoute

from app.accounts.errors import CrossSite, HttpsRequired, NotForScripts, RoleNeeded, ScopeNeeded
from app.accounts.scopes import opened_by
from app.core.errors import (
    GENERAL,
    PROBLEM_JSON,
    NotSignedIn,
    Problem,
    ServiceError,
    TooManyRequests,
    described_problem,
    meaning,
)
from app.core.paging import BadCursor
from app.http.api_examples import EXAMPLES
from app.http.api_parameters import PARAMETERS
from app.robots.corridors.occupied import RobotTraffic
from app.robots.diagnostics import Watched

Document = dict[str, Any]
Codes = Mapping[str, str]
METHODS: Final = ("get", "post", "put", "patch", "delete")

DESCRIPTION: Final = """
Everything that people and programs do with Campus Mail. `docs/reference/api.md` explains the conventions: signing in,
pages of lists, versions, repeated requests, streams, errors.

Any answer may be a problem document (RFC 9457) whose `code` never changes; each operation lists its own. Besides them:
404 `not_found` for a path that is not there, 405 `method_not_allowed`, 500 `unforeseen` for a mistake of ours.
"""

TAGS: Final[Mapping[str, str]] = {
    "about": "What the service says of itself before anybody has signed in: name, time, languages, the map.",
    "people": "Signing in and out, who one is, sessions, tokens, other people.",
    "me": "Who one is: name, language, usual post.",
    "address book": "Whom one exchanged mail with or saved; for dispatchers everybody.",
    "one order": "What a recipient without account reaches by the link in their mail: this one order and nothing else.",
    "orders": "Ordering, following and cancelling, and the codes that go with an order.",
    "standing orders": "Orders that come again on some weekdays.",
    "dispatch": "What dispatchers do with an order that is stuck, or is wanted otherwise.",
    "notices": "What a person was told, and where they want to be told.",
    "outbox": "For dispatchers: notices that a channel has not taken yet, and the mails in the spool.",
    "live": "Changes as they happen, as server-sent events.",
    "robots": "Where the robots were last seen and what they are doing. Their link: `docs/reference/protocol.md`.",
    "upkeep": "For maintainers: watching what a robot senses and thinks.",
    "enrolment": "How a robot becomes known: one-time codes, its key, its tokens.",
    "demo": "Only while a demonstration runs: the simulated robot's camera.",
    "health": "For monitoring.",
}

HEADERS: Final[Mapping[str, str]] = {
    "ETag": "The version of what is answered: for If-None-Match, and of an order for If-Match too.",
    "Idempotency-Replayed": "`true`: this was done before, under this Idempotency-Key, and answered thus.",
    "Link": 'The address of the following page, `rel="next"`; absent on the last.',
    "Location": "Where what was made can be read.",
    "Retry-After": "How many seconds to wait before asking again.",
}
NEVER_KEPT: Final = frozenset({"my_code"})
"""A secret carries no ETag: no client should have a copy to compare."""

HEADERS_OF_STATUS: Final[Mapping[str, tuple[str, ...]]] = {"304": ("ETag",), "429": ("Retry-After",)}

IF_NONE_MATCH: Final = {
    "name": "If-None-Match",
    "in": "header",
    "required": False,
    "description": "An ETag of an earlier answer: 304 if nothing has changed since.",
    "schema": {"type": "string"},
}


class DocumentedApi(FastAPI):
    """A FastAPI application that completes its document."""

    def __init__(self, **settings: Any) -> None:
        tags = [{"name": name, "description": sentence} for name, sentence in TAGS.items()]
        super().__init__(
            **settings, description=DESCRIPTION, openapi_tags=tags, generate_unique_id_function=operation_id
        )

    def openapi(self) -> Document:
        document = super().openapi()
        if "x-complete" not in document["info"]:
            complete(document)
        return document


def _first_sentence(description: str) -> str:
    return " ".join(description.split()).partition(". ")[0].removesuffix(".")


def operation_id(route: APIRoute) -> str:
    return route.name


def operations(document: Document) -> Iterator[tuple[str, str, Document]]:
    """Method, path and operation of everything that the document describes."""
    for path, methods in document["paths"].items():
        for method in METHODS:
            if method in methods:
                yield method, path, methods[method]


def complete(document: Document) -> None:
    """Add, in place, what holds for every operation."""
    document["servers"] = [{"url": "/", "description": "The service that this document comes from."}]
    for method, path, operation in operations(document):
        operation["summary"] = _first_sentence(operation["description"])
        _name_parameters(operation)
        if "security" in operation:
            operation["security"] = _ways_in(operation, method)
        _add_general_problems(operation)
        if method == "get" and path.startswith("/api/") and operation["operationId"] not in NEVER_KEPT:
            _add_etag(operation)
        for status, answer in operation["responses"].items():
            _complete_answer(status, answer)
    components = document.setdefault("components", {})
    components["headers"] = {name: _header(sentence) for name, sentence in HEADERS.items()}
    schemas = components.setdefault("schemas", {})
    for replaced in ("HTTPValidationError", "ValidationError"):
        schemas.pop(replaced, None)
    schemas.update(_problem_schemas())
    schemas.update(_live_schemas())
    for name, examples in EXAMPLES.items():
        if name in schemas:
            schemas[name]["examples"] = list(examples)
    document["info"]["x-complete"] = True


def _name_parameters(operation: Document) -> None:
    for parameter in operation.get("parameters", []):
        if parameter["in"] == "header":
            parameter["name"] = parameter["name"].title()
        if "description" not in parameter and parameter["name"] in PARAMETERS:
            parameter["description"] = PARAMETERS[parameter["name"]]


def _ways_in(operation: Document, method: str) -> list[Document]:
    """A browser's session; a script's token too, if the route takes one, with one of the scopes that are named."""
    scopes = opened_by(operation.get("tags", ()), method.upper()) if _takes_tokens(operation) else ()
    return [{"session": []}, *({"token": [scope]} for scope in sorted(scopes))]


def _general_problems(operation: Document) -> dict[int, dict[str, str]]:
    """Return the answers that any operation of its kind can give, by status and code."""
    found: dict[int, dict[str, str]] = {}
    for applies, what in GENERAL_PROBLEMS:
        if applies(operation):
            for one in what:
                status, code, sentence = _named(one)
                found.setdefault(status, {})[code] = sentence
    return found


def _named(what: str | type[ServiceError]) -> tuple[int, str, str]:
    if isinstance(what, str):
        status, sentence = GENERAL[what]
        return status, what, sentence
    return what.status, what.code, meaning(what)


def _has_body(operation: Document) -> bool:
    return "requestBody" in operation


def _has_parameters(operation: Document) -> bool:
    return bool(operation.get("parameters")) or _has_body(operation)


def _is_closed(operation: Document) -> bool:
    return bool(operation.get("security"))


def _takes_tokens(operation: Document) -> bool:
    return any("token" in way for way in operation.get("security", ()))


def _is_for_browsers_alone(operation: Document) -> bool:
    return _is_closed(operation) and not _takes_tokens(operation)


def _is_open_and_changes(operation: Document) -> bool:
    return _has_body(operation) and not _is_closed(operation)


def _is_paged(operation: Document) -> bool:
    return "Link" in operation["responses"].get("200", {}).get("headers", {})


def _is_limited(operation: Document) -> bool:
    return "429" in operation["responses"]


GENERAL_PROBLEMS: Final[tuple[tuple[Callable[[Document], bool], tuple[str | type[ServiceError], ...]], ...]] = (
    (_is_closed, (NotSignedIn, CrossSite, HttpsRequired, RoleNeeded)),
    (_takes_tokens, (ScopeNeeded,)),
    (_is_for_browsers_alone, (NotForScripts,)),
    (_is_open_and_changes, (CrossSite, HttpsRequired)),
    (_has_body, ("malformed_body", "too_large", "unsupported_media_type")),
    (_has_parameters, ("invalid_request",)),
    (_is_paged, (BadCursor,)),
    (_is_limited, (TooManyRequests,)),
)


def _add_general_problems(operation: Document) -> None:
    answers = operation["responses"]
    if "x-codes" not in answers.get("422", {}):  # FastAPI's own, of another shape
        answers.pop("422", None)
    for status, codes in _general_problems(operation).items():
        own = answers.get(str(status), {}).get("x-codes", {})
        answers[str(status)] = described_problem(status, {**codes, **own})


def _add_etag(operation: Document) -> None:
    """`app.http.etags` gives one to whatever answers JSON and may be kept."""
    answer = operation["responses"].get("200", {})
    if "application/json" not in answer.get("content", {}):
        return
    answer.setdefault("headers", {})["ETag"] = {}
    operation.setdefault("parameters", []).append(IF_NONE_MATCH)
    operation["responses"]["304"] = {"description": "Not changed since the ETag that If-None-Match names."}


def _complete_answer(status: str, answer: Document) -> None:
    named = [*answer.get("headers", {}), *HEADERS_OF_STATUS.get(status, ())]
    if named:
        answer["headers"] = {name: {"$ref": f"#/components/headers/{name}"} for name in named}
    codes = answer.pop("x-codes", None)
    if codes:
        reference = answer["content"][PROBLEM_JSON]["schema"]["$ref"]
        schema = {"allOf": [{"$ref": reference}, {"properties": {"code": {"enum": sorted(codes)}}}]}
        answer["content"] = {PROBLEM_JSON: {"schema": schema}}


def _header(sentence: str) -> Document:
    return {"description": sentence, "schema": {"type": "string"}}


def _problem_schemas() -> Document:
    schema = Problem.model_json_schema(ref_template="#/components/schemas/{model}")
    return {**schema.pop("$defs", {}), "Problem": schema}


def _live_schemas() -> Document:
    """Of events of the stream that no answer carries."""
    found: Document = {}
    for told in (Watched, RobotTraffic):
        schema = told.model_json_schema(ref_template="#/components/schemas/{model}", mode="serialization")
        found |= {**schema.pop("$defs", {}), told.__name__: schema}
    return found


def all_codes() -> dict[str, tuple[int, str]]:
    """Every code that an answer can carry: its status and what it means."""
    found = dict(GENERAL)
    waiting = [ServiceError]
    while waiting:
        for error in waiting.pop().__subclasses__():
            waiting.append(error)
            found[error.code] = (error.status, meaning(error))
    return dict(sorted(found.items()))
