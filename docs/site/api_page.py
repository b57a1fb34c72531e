"""The API as a page: error codes, each operation with what it takes and answers, then the types."""

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final, TypeAlias

CHECKOUT: Final = Path(__file__).parents[2]
METHODS: Final = ("get", "post", "put", "patch", "delete")
Node: TypeAlias = Mapping[str, Any]


def api() -> str:
    """Return every error code, operation and type of the API document."""
    document = _told("--document")
    text = "# API operations\n\nThis page is generated from the OpenAPI document of the service.\n\n"
    return text + _errors() + "".join(_operations(document)) + "".join(_types(document))


def _told(option: str) -> Any:
    command = [sys.executable, "client/make_client.py", option]
    return json.loads(subprocess.run(command, cwd=CHECKOUT, check=True, capture_output=True).stdout)


def _errors() -> str:
    rows = [f"| `{code}` | {status} | {_cell(meaning)} |\n" for code, (status, meaning) in _told("--errors").items()]
    return "## Error codes\n\n| `code` | status | meaning |\n|---|---|---|\n" + "".join(rows) + "\n"


def _operations(document: Node) -> Iterator[str]:
    for tag in document["tags"]:
        found = [
            (f"{method.upper()} {path}", operation)
            for path, item in document["paths"].items()
            for method, operation in item.items()
            if method in METHODS and operation["tags"][0] == tag["name"]
        ]
        if found:
            yield f"## {tag['name'].capitalize()}\n\n{tag.get('description', '')}\n\n"
            yield from (_operation(title, operation) for title, operation in found)


def _operation(title: str, operation: Node) -> str:
    text = f"### {title}\n\n{operation['description']}\n\n"
    text += f"In the Python client: `{operation['operationId']}`. Opened by: {_opened_by(operation)}.\n\n"
    if parameters := [one for one in operation.get("parameters", ()) if "name" in one]:
        text += "| parameter | in | type | meaning |\n|---|---|---|---|\n"
        for one in parameters:
            name = one["name"] + ("" if one.get("required") else "?")
            text += f"| `{name}` | {one['in']} | {kind(one['schema'])} | {_cell(one.get('description', ''))} |\n"
        text += "\n"
    if body := operation.get("requestBody"):
        text += f"Body: {_bodies(body)}.\n\n"
    for status, answer in sorted(operation["responses"].items()):
        words = answer.get("description", "").partition("\n")
        text += (
            f"- **{status}** {words[0]}{': ' + _bodies(answer) if status < '300' and answer.get('content') else ''}\n"
        )
        text += "".join(f"    {line}\n" for line in words[2].splitlines())
    return text + "\n"


def _bodies(holder: Node) -> str:
    return ", ".join(f"{kind(one.get('schema', {}))} (`{media}`)" for media, one in holder["content"].items())


def _opened_by(operation: Node) -> str:
    if "security" not in operation:
        return "everyone"
    scopes = [f"`{scope}`" for way in operation["security"] for scope in way.get("token", ())]
    return ", ".join(["a session", *scopes])


def _types(document: Node) -> Iterator[str]:
    yield "## Types\n\n"
    for name, schema in sorted(document["components"]["schemas"].items()):
        yield f"### {name}\n\n{schema.get('description', '')}\n\n"
        if "enum" in schema:
            yield f"One of {', '.join(f'`{value}`' for value in schema['enum'])}.\n\n"
        if fields := schema.get("properties"):
            required = schema.get("required", ())
            yield "| field | type | meaning |\n|---|---|---|\n"
            for field, of in fields.items():
                optional = "" if field in required else "?"
                yield f"| `{field}{optional}` | {kind(of)} | {_cell(of.get('description', ''))} |\n"
            yield "\n"


def kind(schema: Node) -> str:
    """The type in words, with a link where it has a name: "[OrderView](#orderview) or null"."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    for several in ("anyOf", "oneOf", "allOf"):
        if several in schema:
            return " or ".join(dict.fromkeys(kind(one) for one in schema[several]))
    if "enum" in schema or "const" in schema:
        return ", ".join(f"`{value}`" for value in schema.get("enum", [schema.get("const")]))
    if schema.get("type") == "array":
        return f"list of {kind(schema.get('items', {}))}"
    return str(schema.get("format") or schema.get("type", "anything"))


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
