"""The OpenAPI document can be built on: everything has a name, a meaning, its errors and its headers."""

import re
from collections.abc import Iterator
from typing import Any

import jsonschema_rs
import pytest

from app.composition import create_app
from app.core.errors import PROBLEM_JSON
from app.core.settings import Settings
from app.core.text_lines import LONGEST_TEXT
from app.http.api_document import HEADERS, TAGS, all_codes, operations
from app.http.api_examples import EXAMPLES
from protocol.clock import SteppedClock

NAME = re.compile(r"[a-z]+(_[a-z]+)*")
LIVE = "/api/v1/live"
Operation = tuple[str, str, dict[str, Any]]


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return create_app(Settings(data=tmp_path_factory.mktemp("data")), SteppedClock()).openapi()


@pytest.fixture(scope="module")
def every(document: dict[str, Any]) -> list[Operation]:
    return list(operations(document))


def problems_of(operation: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    return ((status, answer) for status, answer in operation["responses"].items() if status[0] in "45")


def test_operations_are_named_as_methods_are_and_no_name_comes_twice(every: list[Operation]) -> None:
    names = [operation["operationId"] for _, _, operation in every]
    assert [name for name in names if not NAME.fullmatch(name)] == []
    assert len(names) == len(set(names)) > 40


def test_every_operation_says_what_it_does_in_a_sentence(every: list[Operation]) -> None:
    for _, path, operation in every:
        assert operation["description"].strip().endswith((".", "`")), path
        assert 0 < len(operation["summary"]) <= 120, path


def test_every_parameter_says_what_it_is(every: list[Operation]) -> None:
    for _, path, operation in every:
        for parameter in operation.get("parameters", ()):
            assert parameter.get("description"), (
                f"{path} {parameter['name']}: add it to PARAMETERS of app/http/api_document"
            )


def test_whatever_people_write_as_a_description_or_a_reason_may_be_equally_long(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    asked = {name: schema for name, schema in schemas.items() if schema.get("additionalProperties") is False}
    longest = {
        f"{name}.{field}": [one["maxLength"] for one in said.get("anyOf", [said]) if "maxLength" in one]
        for name, schema in asked.items()
        for field, said in schema["properties"].items()
        if field in ("description", "reason")
    }
    assert len(longest) > 6
    assert {name: found for name, found in longest.items() if found != [LONGEST_TEXT]} == {}


def test_every_tag_is_described_and_used(every: list[Operation]) -> None:
    assert {tag for _, _, operation in every for tag in operation["tags"]} == set(TAGS)


def test_every_error_answer_is_a_problem_document_that_lists_its_codes(every: list[Operation]) -> None:
    known = set(all_codes())
    for method, path, operation in every:
        for status, answer in problems_of(operation):
            assert list(answer["content"]) == [PROBLEM_JSON], (method, path, status)
            schema = answer["content"][PROBLEM_JSON]["schema"]
            assert "allOf" in schema, f"{method} {path} {status} lists no code: name the error class in problems(…)"
            codes = schema["allOf"][1]["properties"]["code"]["enum"]
            assert set(codes) <= known
            assert all(f"`{code}`" in answer["description"] for code in codes)


def test_every_code_has_one_meaning_wherever_it_is_raised() -> None:
    assert [code for code, (status, meaning) in all_codes().items() if status < 400 or not meaning.endswith(".")] == []


def test_headers_are_described_once_and_referred_to(document: dict[str, Any], every: list[Operation]) -> None:
    assert set(document["components"]["headers"]) == set(HEADERS)
    for _, path, operation in every:
        for answer in operation["responses"].values():
            for name, header in answer.get("headers", {}).items():
                assert header == {"$ref": f"#/components/headers/{name}"}, path


def test_the_headers_that_clients_build_on_are_where_they_belong(document: dict[str, Any]) -> None:
    paths = document["paths"]
    place, listed = paths["/api/v1/orders"]["post"], paths["/api/v1/orders"]["get"]
    cancel = paths["/api/v1/orders/{order_id}/cancel"]["post"]

    def asks(operation: dict[str, Any]) -> set[str]:
        return {one["name"] for one in operation["parameters"] if one["in"] == "header"}

    assert set(place["responses"]["201"]["headers"]) == {"Location", "ETag", "Idempotency-Replayed"}
    assert "Retry-After" in place["responses"]["429"]["headers"]
    assert "Idempotency-Key" in asks(place)
    assert set(listed["responses"]["200"]["headers"]) == {"Link", "ETag"}
    assert "304" in listed["responses"]
    assert "If-None-Match" in asks(listed)
    assert "If-Match" in asks(cancel)
    assert "Last-Event-Id" in asks(paths[LIVE]["get"])


def test_who_may_come_how_is_said_with_the_scopes_of_scripts(document: dict[str, Any]) -> None:
    assert set(document["components"]["securitySchemes"]) == {"session", "token"}
    paths = document["paths"]
    assert paths["/api/v1/orders"]["post"]["security"] == [{"session": []}, {"token": ["orders:write"]}]
    assert paths["/api/v1/tokens"]["post"]["security"] == [{"session": []}], "no script makes tokens"
    assert "security" not in paths["/api/v1/about"]["get"]


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_what_its_schema_says(document: dict[str, Any], name: str) -> None:
    schema = jsonschema_rs.validator_for({**document, "$ref": f"#/components/schemas/{name}"})
    for example in EXAMPLES[name]:
        assert [str(one.message) for one in schema.iter_errors(example)] == []
    assert document["components"]["schemas"][name]["examples"] == list(EXAMPLES[name])


def test_whatever_a_client_writes_first_has_an_example(every: list[Operation]) -> None:
    bodies = {
        operation["requestBody"]["content"]["application/json"]["schema"]["$ref"].rpartition("/")[2]
        for _, _, operation in every
        if "requestBody" in operation
    }
    assert bodies <= set(EXAMPLES), f"app/http/api_examples.py lacks {sorted(bodies - set(EXAMPLES))}"


def test_the_document_describes_the_event_stream(document: dict[str, Any]) -> None:
    assert document["openapi"] == "3.2.0"
    assert "text/event-stream" in document["paths"][LIVE]["get"]["responses"]["200"]["content"]


def test_no_text_that_a_request_may_hold_has_a_zero_byte_which_one_of_the_databases_refuses(
    document: dict[str, Any], every: list[Operation]
) -> None:
    for _, path, operation in every:
        bodies = operation.get("requestBody", {}).get("content", {}).values()
        asked = [*(one for one in operation.get("parameters", ()) if one["in"] in ("query", "path")), *bodies]
        for text in (text for one in asked for text in texts_in(one["schema"], document)):
            kept_nowhere = text.get("title") in ("Cursor", "Zone", "State", "Code", "Error")
            is_one_of_few = {"enum", "const", "format"} & text.keys()
            assert is_one_of_few or kept_nowhere or not re.search(text.get("pattern", ""), "a\0b"), (path, text)


def texts_in(schema: dict[str, Any], document: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the schemas of texts that something of this schema may hold."""
    if "$ref" in schema:
        schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    if schema.get("type") == "string":
        yield schema
    parts = [schema.get("items"), *schema.get("properties", {}).values(), *schema.get("anyOf", ())]
    for part in parts:
        yield from texts_in(part, document) if part else ()
