"""Checks for schemathesis besides its own, and callers for routes that end their session.

Its command loads this file too (SCHEMATHESIS_HOOKS).
"""

import json
import os
from typing import Any, Final

import schemathesis

SESSIONS: Final[list[str]] = json.loads(os.environ.get("SESSIONS_TO_END", "[]"))
NO_HTTP: Final = b"Invalid HTTP request received."
"""The server's own answer (uvicorn) to bytes that are no request, before any of our code sees them."""
ENDS_SESSIONS: Final = frozenset({"sign_out", "sign_out_elsewhere", "end_one_session"})


@schemathesis.check
def the_code_is_documented(ctx: Any, response: Any, case: Any) -> None:
    """Every error answer is a problem document whose code the operation lists."""
    if response.status_code < 400 or (response.status_code == 400 and response.content == NO_HTTP):
        return
    kind = response.headers.get("content-type", ["none"])[0]
    assert kind == "application/problem+json", f"{kind}: {response.content[:200]!r}"
    problem = response.json()
    listed = case.operation.definition.raw["responses"].get(str(response.status_code))
    assert problem["status"] == response.status_code
    if listed is not None:
        schema = listed["content"]["application/problem+json"]["schema"]
        codes = schema["allOf"][1]["properties"]["code"]["enum"] if "allOf" in schema else []
        assert problem["code"] in codes, f"{problem['code']} is not among {codes}"


def own_session(case: Any) -> dict[str, str]:
    """Return a session of its own for a sign-out, so that the others' go on."""
    ends = case.operation.definition.raw.get("operationId") in ENDS_SESSIONS
    return {"Cookie": f"session={SESSIONS.pop()}"} if ends and SESSIONS else {}


if SESSIONS:  # its command, which knows one way in for all

    @schemathesis.hook
    def before_call(context: Any, case: Any, kwargs: dict[str, Any]) -> None:
        case.headers.update(own_session(case))

    @schemathesis.hook
    def filter_failure(context: Any, failure: Any, case: Any, response: Any) -> bool:
        """Its "request without a cookie" has one all the same: the command gives it to every request."""
        return not ("`session`" in failure.message and "cookie" in failure.message)
