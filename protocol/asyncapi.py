"""The robot's link as an AsyncAPI 3 document, made of the message classes: `python -m protocol --asyncapi`.

It is seen from the service: what robots say it receives, what it says it sends.
"""

import inspect
import json
from collections.abc import Iterable, Mapping
from typing import Any, Final

from pydantic.json_schema import models_json_schema

from protocol.envelope import DURABLE, MAJOR_VERSION, MINOR_VERSION, TO_ROBOT, TO_SERVER, Envelope
from protocol.example_files import EXAMPLES, examples_of
from protocol.parts import Part

ADDRESS: Final = "/api/v1/robots/link"
CHANNEL: Final = "#/channels/link"
SCHEMAS: Final = "#/components/schemas/"
EVERY: Final[Mapping[str, type[Part]]] = {**TO_SERVER, **TO_ROBOT}
Json = dict[str, Any]

DESCRIPTION: Final = """\
One WebSocket per robot, opened by the robot and signed in with its token. Tunnels have patches without network, so the
connection is expected to be away for minutes: durable messages are numbered, kept on disk and sent until they are
acknowledged. What that means, how a connection begins, close codes and error codes are in `docs/reference/protocol.md`.
"""


def document() -> Json:
    """The whole document."""
    return {
        "asyncapi": "3.0.0",
        "id": "urn:campus-mail:robot-link",
        "info": {
            "title": "Campus Mail: the link between service and robot",
            "version": f"{MAJOR_VERSION}.{MINOR_VERSION}.0",
            "description": DESCRIPTION,
            "tags": [{"name": "durable", "description": "Numbered, kept on disk, sent until it is acknowledged."}],
        },
        "defaultContentType": "application/json",
        "servers": {"service": _server()},
        "channels": {"link": _channel()},
        "operations": {
            "hearRobot": _operation("receive", "What robots say.", TO_SERVER),
            "tellRobot": _operation("send", "What robots are told.", TO_ROBOT),
        },
        "components": {
            "messages": {name: _message(name, kind) for name, kind in EVERY.items()},
            "schemas": _schemas(),
            "securitySchemes": {"robotToken": {"type": "http", "scheme": "bearer", "bearerFormat": "cmr_…"}},
        },
    }


def as_text() -> str:
    """The document as it is printed."""
    return json.dumps(document(), indent=2, ensure_ascii=False) + "\n"


def _server() -> Json:
    return {
        "host": "mail.campus.example",
        "protocol": "wss",
        "description": "Plain ws is taken from the same machine alone.",
        "security": [{"$ref": "#/components/securitySchemes/robotToken"}],
    }


def _channel() -> Json:
    return {
        "address": ADDRESS,
        "description": "Begins with `hello` and `welcome`; each message is one JSON text of at most 64 KiB.",
        "servers": [{"$ref": "#/servers/service"}],
        "messages": {name: {"$ref": f"#/components/messages/{name}"} for name in EVERY},
        "bindings": {"ws": {"method": "GET", "bindingVersion": "0.1.0"}},
    }


def _operation(action: str, description: str, messages: Iterable[str]) -> Json:
    return {
        "action": action,
        "channel": {"$ref": CHANNEL},
        "description": description,
        "messages": [{"$ref": f"{CHANNEL}/messages/{name}"} for name in messages],
    }


def _message(name: str, kind: type[Part]) -> Json:
    meaning = inspect.cleandoc(kind.__doc__ or "")
    return {
        "name": name,
        "title": name.replace("_", " ").capitalize(),
        "summary": " ".join(meaning.split("\n\n")[0].split()),
        "description": meaning,
        "contentType": "application/json",
        "tags": [{"name": "durable"}] if name in DURABLE else [],
        "payload": {"allOf": [{"$ref": f"{SCHEMAS}Envelope"}, _narrowed(name, kind)]},
        "examples": [
            {
                "name": path.stem,
                "summary": str(path.relative_to(EXAMPLES.parents[1])),
                "payload": json.loads(path.read_text()),
            }
            for path in examples_of(name)
        ],
    }


def _narrowed(name: str, kind: type[Part]) -> Json:
    """Return the constraints that the envelope of this message must meet."""
    seq = {"type": "integer"} if name in DURABLE else {"type": "null"}
    body = {"$ref": f"{SCHEMAS}{kind.__name__}"}
    required = ["body", "seq"] if name in DURABLE else ["body"]
    return {"properties": {"type": {"const": name}, "seq": seq, "body": body}, "required": required}


def _schemas() -> Json:
    kinds = [(kind, "validation") for kind in (Envelope, *dict.fromkeys(EVERY.values()))]
    _, made = models_json_schema(kinds, ref_template=SCHEMAS + "{model}")  # type: ignore[arg-type]
    schemas: Json = made["$defs"]
    schemas["Envelope"]["properties"]["body"] = {"type": "object"}
    del schemas["Part"]
    for schema in schemas.values():
        _plain_discriminators(schema)
    return dict(sorted(schemas.items()))


def _plain_discriminators(schema: Any) -> None:
    """AsyncAPI names the field alone; which value means which schema is said by the schemas' constants."""
    for value in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        _plain_discriminators(value)
    if isinstance(schema, dict) and isinstance(schema.get("discriminator"), dict):
        schema["discriminator"] = schema["discriminator"]["propertyName"]
