"""The AsyncAPI document says what the classes say: its schemas take and refuse what the parser takes and refuses."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest

from protocol.asyncapi import EVERY, document
from protocol.envelope import parse
from protocol.errors import ProtocolError
from protocol.example_files import EXAMPLES

DOCUMENT = document()
FILES = sorted(EXAMPLES.glob("*.json"))


def validator(name: str) -> jsonschema_rs.Validator:
    """Of one message, with the document around it for its references."""
    return jsonschema_rs.validator_for({**DOCUMENT, "$ref": f"#/components/messages/{name}/payload"})


@pytest.fixture(scope="module")
def validators() -> dict[str, jsonschema_rs.Validator]:
    return {name: validator(name) for name in EVERY}


def test_every_reference_leads_somewhere() -> None:
    for reference in _references(DOCUMENT):
        place: Any = DOCUMENT
        for step in reference.removeprefix("#/").split("/"):
            place = place[step]


def test_every_message_is_told_or_heard_and_has_an_example() -> None:
    told = {one["$ref"].rpartition("/")[2] for kind in DOCUMENT["operations"].values() for one in kind["messages"]}
    assert told == set(DOCUMENT["components"]["messages"]) == set(EVERY)
    assert [name for name, message in DOCUMENT["components"]["messages"].items() if not message["examples"]] == []


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_an_example_is_what_its_schema_says_and_no_other_message(
    path: Path, validators: dict[str, jsonschema_rs.Validator]
) -> None:
    raw = json.loads(path.read_text())
    assert [name for name, one in validators.items() if one.is_valid(raw)] == [raw["type"]]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_what_the_parser_refuses_the_schema_refuses(path: Path, validators: dict[str, jsonschema_rs.Validator]) -> None:
    raw = json.loads(path.read_text())
    for changed in _spoilt(raw):
        with pytest.raises(ProtocolError):
            parse(json.dumps(changed), EVERY)
        assert not validators[raw["type"]].is_valid(changed), changed


def _spoilt(raw: dict[str, Any]) -> Iterator[dict[str, Any]]:
    yield {**raw, "colour": "red"}
    yield {**raw, "body": {**raw["body"], "colour": "red"}}
    yield {**raw, "robot": "no name"}
    yield {**raw, "seq": None if raw["seq"] else 7}
    for field in raw["body"]:
        yield {**raw, "body": {**raw["body"], field: _misfit()}}


def _misfit() -> dict[str, str]:
    return {"no field": "of ours"}


def _references(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        if isinstance(value.get("$ref"), str):
            yield value["$ref"]
        for one in value.values():
            yield from _references(one)
    if isinstance(value, list):
        for one in value:
            yield from _references(one)
