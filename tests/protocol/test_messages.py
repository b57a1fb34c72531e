"""Every message has an example file, which is read, written and documented; nothing else is ever let in."""

import ast
import base64
import hmac
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
from hypothesis import given
from hypothesis import strategies as st

from protocol.__main__ import messages_as_markdown
from protocol.both_ways import Error
from protocol.envelope import DURABLE, MAX_MESSAGE_BYTES, TO_ROBOT, TO_SERVER, Envelope, parse, type_of
from protocol.errors import MalformedMessage, MessageTooLarge, NewerVersion, ProtocolError, UnknownMessage
from protocol.example_files import EXAMPLES, examples_of
from protocol.parts import Part, sentence
from protocol.proofs import ShownCode
from protocol.to_server import HandoverReceipt

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "reference" / "protocol.md"
EVERY = {**TO_SERVER, **TO_ROBOT}
FILES = sorted(EXAMPLES.glob("*.json"))
TEXTS = {path.stem: path.read_text() for path in FILES}
texts = st.text(st.characters(), max_size=20)  # half surrogate pairs among them
json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | texts,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(texts, inner, max_size=4),
    max_leaves=10,
)


def accepted_by(name: str) -> Mapping[str, type[Part]]:
    return TO_SERVER if name in TO_SERVER else TO_ROBOT


def example(stem: str) -> dict[str, Any]:
    raw: dict[str, Any] = json.loads(TEXTS[stem])
    return raw


@pytest.mark.parametrize("name", EVERY)
def test_every_message_has_an_example_file(name: str) -> None:
    assert EXAMPLES / f"{name}.json" in examples_of(name)


def test_the_example_of_an_error_is_what_a_robot_answers_today() -> None:
    unknown = json.dumps({**example("pause"), "type": "dance"})
    with pytest.raises(UnknownMessage) as refused:
        parse(unknown, TO_ROBOT)
    assert example("error")["body"]["message"] == str(refused.value)
    assert example("error")["body"]["code"] == refused.value.code


def test_every_example_file_is_of_a_message_and_every_kind_of_event_is_among_them() -> None:
    kinds = set()
    for stem, text in TEXTS.items():
        envelope = parse(text, EVERY)
        assert f"{stem}_".startswith(f"{envelope.type}_")
        if envelope.type == "event":
            kinds.add(example(stem)["body"]["happened"]["kind"])
    assert kinds == {"progress", "handover", "charge", "fault", "answer"}


@pytest.mark.parametrize("stem", TEXTS)
def test_an_example_is_read_and_written_without_change(stem: str) -> None:
    envelope = parse(TEXTS[stem], EVERY)
    assert type_of(envelope.body) == envelope.type
    assert json.loads(envelope.to_text()) == example(stem)
    assert parse(envelope.to_text(), EVERY) == envelope


@pytest.mark.parametrize("stem", TEXTS)
def test_durable_messages_and_no_others_carry_a_number(stem: str) -> None:
    raw = example(stem)
    assert (raw["seq"] is not None) == (raw["type"] in DURABLE)
    raw["seq"] = None if raw["type"] in DURABLE else 7
    with pytest.raises(MalformedMessage, match="seq: durable messages carry a seq, others none"):
        parse(json.dumps(raw), EVERY)


def test_messages_are_frozen_and_exact() -> None:
    envelope = parse(TEXTS["claim"], TO_SERVER)
    with pytest.raises(ValueError, match="frozen"):
        envelope.body.claim_id = "other"  # type: ignore[attr-defined]
    raw = example("claim")
    raw["body"]["colour"] = "red"
    with pytest.raises(MalformedMessage, match=r"claim: colour: Extra inputs are not permitted") as caught:
        parse(json.dumps(raw), TO_SERVER)
    assert caught.value.seq == raw["seq"], "the sender can find it again"


@pytest.mark.parametrize(
    ("stem", "place", "value"),
    [
        ("ack", "ack", 2**60),
        ("clear", "seq", 2**60),
        ("clear", "at", "0001-01-01T00:00:00+14:00"),
        ("clear", "at", "1969-12-31T23:59:59Z"),
        ("clear", "at", "2026-01-05T09:00:00"),
    ],
)
def test_numbers_and_times_that_no_database_could_keep_are_malformed(stem: str, place: str, value: object) -> None:
    with pytest.raises(MalformedMessage, match=place):
        parse(json.dumps({**example(stem), place: value}), EVERY)


def test_a_sentence_with_a_zero_byte_is_malformed_since_postgresql_could_not_keep_it() -> None:
    raw = example("why")
    raw["body"]["sentence"] = "It waits\x00."
    with pytest.raises(MalformedMessage, match="sentence"):
        parse(json.dumps(raw), TO_SERVER)
    assert sentence("It waits\x00." + 600 * "!") == ("It waits." + 600 * "!")[:500]


@pytest.mark.parametrize("stem", ["mission", "grant", "welcome"])
def test_what_goes_to_the_robot_is_unknown_to_the_server(stem: str) -> None:
    with pytest.raises(UnknownMessage, match="is not known here; known are"):
        parse(TEXTS[stem], TO_SERVER)


@pytest.mark.parametrize("version", [2, 10**30])
def test_a_newer_version_is_named_whatever_else_it_says(version: int) -> None:
    with pytest.raises(NewerVersion, match="update this side first"):
        parse(json.dumps({"v": version, "type": "teleport", "payload": []}), TO_ROBOT)


@pytest.mark.parametrize("version", [0, -1, 1.0, "1", None, True])
def test_a_version_that_is_none_is_malformed(version: object) -> None:
    with pytest.raises(MalformedMessage, match="v: a whole number from 1"):
        parse(json.dumps({**example("ack"), "v": version}), TO_ROBOT)


def test_a_message_that_is_too_large_is_not_even_read() -> None:
    with pytest.raises(MessageTooLarge, match=f"at most {MAX_MESSAGE_BYTES}"):
        parse("[" * (MAX_MESSAGE_BYTES + 1), TO_ROBOT)
    with pytest.raises(MessageTooLarge):
        parse("é" * (MAX_MESSAGE_BYTES // 2 + 1), TO_ROBOT)


def only_protocol_errors(text: str | bytes) -> Envelope | None:
    try:
        return parse(text, EVERY)
    except ProtocolError as error:
        answer = Error(code=error.code, message=str(error)[:500], seq=error.seq)
        assert answer.message
        assert answer.model_dump_json(), "it can be sent"
        return None


@given(st.text(st.characters()) | st.binary())
def test_no_text_raises_anything_but_a_protocol_error(text: str | bytes) -> None:
    only_protocol_errors(text)


@given(json_values)
def test_no_json_raises_anything_but_a_protocol_error(value: object) -> None:
    only_protocol_errors(json.dumps(value))


@given(st.sampled_from(FILES), st.data())
def test_no_change_to_a_message_raises_anything_but_a_protocol_error(path: Path, data: st.DataObject) -> None:
    """Somewhere in a sound message, something else; what is let in all the same is what a message says."""
    raw = json.loads(path.read_text())
    place, key = data.draw(st.sampled_from(list(_places(raw))))
    place[key] = data.draw(json_values)
    envelope = only_protocol_errors(json.dumps(raw))
    if envelope is not None:
        assert parse(envelope.to_text(), EVERY) == envelope


@given(st.sampled_from(FILES), st.integers(0, 2000), st.text(max_size=3))
def test_a_torn_message_raises_a_protocol_error(path: Path, at: int, stray: str) -> None:
    text = path.read_text()
    only_protocol_errors(text[:at] + stray + text[at + 1 :])
    with pytest.raises(ProtocolError):
        parse(text[: min(at, len(text.rstrip()) - 1)], EVERY)


def _places(value: Any) -> list[tuple[Any, Any]]:
    """Every place in a JSON value that holds something: container and key."""
    if not isinstance(value, dict | list):
        return []
    keys = list(value) if isinstance(value, dict) else list(range(len(value)))
    return [(value, key) for key in keys] + [place for key in keys for place in _places(value[key])]


def test_the_reference_shows_every_message_with_its_examples() -> None:
    shown = messages_as_markdown()
    assert [name for name in (*TO_SERVER, *TO_ROBOT) if f"### {name}\n" not in shown] == []
    assert [path.name for path in EXAMPLES.glob("*.json") if path.read_text() not in shown] == []


def test_the_documentation_names_every_error_code_of_the_link() -> None:
    page = PAGE.read_text()
    sources = [ROOT / "protocol/errors.py", ROOT / "app/robots/errors.py", ROOT / "robot/mission/mission_updates.py"]
    codes = {code for path in sources for code in _codes_of_link(path)}
    assert codes >= {"malformed_message", "message_gap", "mission_conflict", "unknown_stop"}
    assert [code for code in sorted(codes) if f"`{code}`" not in page] == []


def test_the_documentation_names_every_alarm() -> None:
    calls = [
        node
        for path in (ROOT / "app").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "raise_alarm"
    ]
    names = {call.args[2].value for call in calls if isinstance(call.args[2], ast.Constant)}
    assert "second_socket" in names
    assert [name for name in sorted(map(str, names)) if f"`{name}`" not in PAGE.read_text()] == []


def _codes_of_link(path: Path) -> set[str]:
    """The `code = "…"` of the error classes in a file; base classes and those that answer HTTP requests excepted."""
    not_on_the_link = {
        *("protocol_error", "fleet_error"),
        *("robot_exists", "robot_name_invalid", "unknown_robot", "unknown_alarm"),
        *("no_such_corridor", "robot_away", "robot_goes_on", "robot_too_old"),
    }
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id == "code":
            assert isinstance(node.value, ast.Constant)
            found.add(str(node.value.value))
    return found - not_on_the_link


def test_the_signatures_of_the_examples_are_those_of_the_key_in_the_documentation() -> None:
    key = Ed25519PublicKey.from_public_bytes(base64.b64decode("A6EHv/POEL4dcN0Y50vAmWfk1jCbpQ1fHdyGZBJVMbg="))
    for stem in ("event", "event_handover_tap"):
        receipt = parse(TEXTS[stem], TO_SERVER).body.happened  # type: ignore[attr-defined]
        key.verify(base64.b64decode(receipt.signature), receipt.signed_by("r1"))


def test_the_proof_of_the_example_is_that_of_the_code_in_the_documentation() -> None:
    receipt = parse(TEXTS["event"], TO_SERVER).body.happened  # type: ignore[attr-defined]
    shown = ShownCode.of("CM1:000102030405060708090a0b0c0d0e0f")
    assert shown.sha256 == receipt.code_sha256
    key = hmac.digest(b"campus-mail hand-over proof 1", b"CM1:000102030405060708090a0b0c0d0e0f", "sha256")
    values = (
        receipt.order_id,
        receipt.mission_id,
        receipt.stop_id,
        "load",
        "post1",
        "7",
        "2026-01-05T09:03:40.000000Z",
    )
    framed = b"".join(len(value).to_bytes(4, "big") + value.encode() for value in values)
    assert receipt.proof == hmac.new(key, framed, "sha256").hexdigest() == receipt.proved_with(shown.key)


def test_no_two_hand_overs_have_the_same_proof() -> None:
    receipt = parse(TEXTS["event"], TO_SERVER).body.happened  # type: ignore[attr-defined]
    moved = receipt.model_copy(update={"order_id": receipt.order_id[:-1], "mission_id": f"4{receipt.mission_id}"})
    others = [
        moved,
        *(receipt.model_copy(update=change) for change in ({"number": 8}, {"stop_id": "s"}, {"post": "p"})),
    ]
    assert len({one.proved_with(b"key") for one in (receipt, *others)}) == 5


def test_the_signature_of_a_robot_that_is_older_than_proofs_is_good_still() -> None:
    raw = example("event")["body"]["happened"]
    for name in ("mission_id", "number", "proof"):
        del raw[name]
    receipt = HandoverReceipt.model_validate_json(json.dumps({**raw, "code_sha256": "b7f1" * 16}))
    key = Ed25519PublicKey.from_public_bytes(base64.b64decode("A6EHv/POEL4dcN0Y50vAmWfk1jCbpQ1fHdyGZBJVMbg="))
    as_it_was = "1CppfAhf4wkUBAaHmBx2KbZReb5u9O+c3VcyG6EYTuhuu4zJ3haiH60c9g3MZT4c6sPcVYbSZP9uTG+9Y4qMBw=="
    key.verify(base64.b64decode(as_it_was), receipt.signed_by("r1"))


def test_a_receipt_of_a_robot_that_knows_no_signatures_is_understood() -> None:
    raw = example("event")
    for name in ("how", "command_id", "mission_id", "number", "proof", "signature"):
        del raw["body"]["happened"][name]
    receipt = parse(json.dumps(raw), TO_SERVER).body.happened  # type: ignore[attr-defined]
    assert (receipt.how, receipt.signature) == ("code", None)
    raw["body"]["happened"]["code_sha256"] = None
    assert parse(json.dumps(raw), TO_SERVER).body.happened.how == "button"  # type: ignore[attr-defined]


@pytest.mark.parametrize("text", ['"\ud800"', '{"v": "\ud800"}', '{"v": "\\ud800"}', "[" * 50_000, b"\xff\xfe{"])
def test_half_of_a_pair_and_deep_brackets_are_malformed(text: str | bytes) -> None:
    with pytest.raises(MalformedMessage, match="not JSON"):
        parse(text, TO_SERVER)
