"""`make client` writes what follows from the service's OpenAPI document, and a client for programs that do not await.
`--document` prints that document instead, `--errors` every error code with its status and meaning.

models.py             a pydantic class for each schema
problems.py           an exception for each code that an answer can carry
async_operations.py   a method for each operation
operations.py, client.py   the same without `await`, made of the files for those who do
"""

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from keyword import iskeyword
from pathlib import Path
from textwrap import dedent, wrap
from typing import Any, Final

import structlog

sys.path[:0] = [str(Path(__file__).parents[1])]

from app.composition import create_app  # noqa: E402
from app.core.settings import Settings  # noqa: E402
from app.http.api_document import all_codes, operations  # noqa: E402  # the checkout is on the path only now
from protocol.clock import RealClock  # noqa: E402

PACKAGE: Final = Path(__file__).parent / "campus_mail_client"
BY_HAND: Final = frozenset({"live"})
"""Operations that have a method written by hand: a stream is no call."""
NOT_FOR_PROGRAMS: Final = frozenset({"demo", "health"})
OF_THE_TRANSPORT: Final = frozenset({"If-None-Match", "Accept-Language", "User-Agent", "Last-Event-Id"})
WITHOUT_AWAIT: Final = {
    "AsyncCampusMail": "CampusMail",
    "AsyncOperations": "Operations",
    "async_operations": "operations",
    "async with": "with",
    "async for": "for",
    "async def": "def",
    "await ": "",
    "asyncio.sleep": "time.sleep",
    "import asyncio": "import time",
    "AsyncBaseTransport": "BaseTransport",
    "AsyncClient": "Client",
    "AsyncGenerator[Change, None]": "Generator[Change, None, None]",
    "AsyncGenerator": "Generator",
    "AsyncIterator": "Iterator",
    "Awaitable[Page[Item]]": "Page[Item]",
    "Awaitable, ": "",
    "aclosing": "closing",
    "__aenter__": "__enter__",
    "__aexit__": "__exit__",
    "aclose": "close",
    "aread": "read",
    "aiter_lines": "iter_lines",
}
FIX: Final = ["check", "--quiet", "--select", "I,F401,UP028", "--fix", "--unsafe-fixes"]
Schema = dict[str, Any]


def document() -> Schema:
    """The OpenAPI document of the service as it is in this checkout."""
    with tempfile.TemporaryDirectory() as folder:
        app = create_app(Settings(data=Path(folder)), RealClock())
        return app.openapi()


def made_files(openapi: Schema) -> dict[str, str]:
    """Every file that is made, by its name."""
    awaiting = "".join(_operations(openapi))
    client = (PACKAGE / "async_client.py").read_text().split('"""', 2)[2]
    head = '"""Campus Mail for programs that do not await: made of async_client.py by make_client.py."""'
    raw = {
        "models.py": "".join(_models(openapi)),
        "problems.py": "".join(_problems()),
        "async_operations.py": awaiting,
        "operations.py": without_await(awaiting),
        "client.py": without_await(head + client),
    }
    return {name: _formatted(name, text) for name, text in raw.items()}


def without_await(text: str) -> str:
    """The same for programs that do not await."""
    for awaiting, plain in WITHOUT_AWAIT.items():
        text = re.sub(
            rf"(?<![A-Za-z_]){re.escape(awaiting)}(?![A-Za-z])" if awaiting[-1] != " " else awaiting, plain, text
        )
    return text


def _formatted(name: str, text: str) -> str:
    for arguments in (FIX, ["format", "--quiet"]):
        command = [sys.executable, "-m", "ruff", *arguments, "--stdin-filename", str(PACKAGE / name), "-"]
        text = subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout
    return text


def _models(openapi: Schema) -> Iterator[str]:
    yield '"""What the service takes and answers: made of its OpenAPI document by make_client.py."""\n'
    yield "from __future__ import annotations\n"
    yield "from datetime import date, datetime\nfrom typing import Any, Literal\n"
    yield "from pydantic import BaseModel, ConfigDict, Field\n"
    yield dedent('''
        class Model(BaseModel):
            """Frozen; what a newer service says besides is ignored."""

            model_config = ConfigDict(frozen=True, extra="ignore", validate_by_name=True, validate_by_alias=True)
    ''')
    for name, schema in _used_schemas(openapi).items():
        yield from (
            _model(name, schema) if "properties" in schema or schema.get("type") == "object" else _alias(name, schema)
        )


def _used_schemas(openapi: Schema) -> dict[str, Schema]:
    """Those that the client's made operations speak of; error answers are exceptions.

    The stream tells the same, and what a robot senses and thinks, which the pages alone look at.
    """
    schemas = openapi["components"]["schemas"]
    waiting = [one for _, _, one in _for_programs(openapi) if one["operationId"] not in BY_HAND]
    used: dict[str, Schema] = {}
    while waiting:
        for name in re.findall(r"#/components/schemas/([A-Za-z0-9_]+)", str(waiting.pop())):
            if name not in used and name not in {"Problem", "FieldProblem"}:
                used[name] = schemas[name]
                waiting.append(schemas[name])
    return dict(sorted(used.items()))


def _alias(name: str, schema: Schema) -> Iterator[str]:
    yield f"{name} = {_type(schema)}\n"
    if "description" in schema:
        yield f'"""{_one_line(schema["description"])}"""\n'


def _model(name: str, schema: Schema) -> Iterator[str]:
    yield f'\nclass {name}(Model):\n    """{_paragraphs(schema.get("description", name), 4)}"""\n\n'
    for field, kind in schema.get("properties", {}).items():
        yield _field(field, kind, field in schema.get("required", ()))


def _field(name: str, schema: Schema, required: bool) -> str:
    plain = f"{name}_" if name in {"from", "global", "class"} else name
    kind = _type(schema)
    if not required and "default" not in schema:
        kind += "" if kind.endswith("None") else " | None"
    given = {"alias": repr(name)} if plain != name else {}
    if not required:
        given = {"default": repr(schema.get("default")), **given}
    if not given:
        return f"    {plain}: {kind}\n"
    if list(given) == ["default"]:
        return f"    {plain}: {kind} = {given['default']}\n"
    return f"    {plain}: {kind} = Field({', '.join(f'{key}={value}' for key, value in given.items())})\n"


def _type(schema: Schema) -> str:
    """The Python type of a JSON schema. Words are open: a newer service may know more of them."""
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    if "anyOf" in schema or "oneOf" in schema:
        return " | ".join(dict.fromkeys(_type(one) for one in schema.get("anyOf") or schema["oneOf"]))
    if "enum" in schema or "const" in schema:
        words = schema.get("enum") or [schema["const"]]
        return f"Literal[{', '.join(map(repr, words))}]" + (" | str" if isinstance(words[0], str) else "")
    if "prefixItems" in schema:
        return f"tuple[{', '.join(_type(one) for one in schema['prefixItems'])}]"
    return _plain_type(schema)


def _plain_type(schema: Schema) -> str:
    match schema.get("type"):
        case "array":
            return f"list[{_type(schema.get('items', {}))}]"
        case "object":
            values = schema.get("additionalProperties")
            return f"dict[str, {_type(values) if isinstance(values, dict) else 'Any'}]"
        case "string":
            return {"date-time": "datetime", "date": "date"}.get(schema.get("format", ""), "str")
        case kind:
            return {"integer": "int", "number": "float", "boolean": "bool", "null": "None"}.get(str(kind), "Any")


def _problems() -> Iterator[str]:
    yield '"""An exception for each `code` of the service: made of its error classes by make_client.py."""\n'
    yield "from collections.abc import Mapping\nfrom typing import Final\n"
    yield "from campus_mail_client.errors import Problem\n"
    names = {code: _class_name(code) for code in all_codes()}
    for code, (status, meaning) in all_codes().items():
        said = _paragraphs(f"{meaning} ({status})", 4)
        yield f'\nclass {names[code]}(Problem):\n    """{said}"""\n\n    code = "{code}"\n\n'
    yield "BY_CODE: Final[Mapping[str, type[Problem]]] = {\n"
    yield from (f'    "{code}": {name},\n' for code, name in names.items())
    yield "}\n"


def _class_name(code: str) -> str:
    return "".join(word.capitalize() for word in code.split("_"))


def _for_programs(openapi: Schema) -> Iterator[tuple[str, str, Schema]]:
    for method, path, operation in operations(openapi):
        if not NOT_FOR_PROGRAMS & set(operation["tags"]):
            yield method, path, operation


def _operations(openapi: Schema) -> Iterator[str]:
    yield '"""One method for each operation: made of the service\'s OpenAPI document by make_client.py."""\n'
    yield "from datetime import date, datetime\nfrom typing import Any, Literal\nfrom urllib.parse import quote\n"
    yield f"from campus_mail_client.models import {', '.join(_used_schemas(openapi))}\n"
    yield dedent('''
        class AsyncOperations:
            """What can be asked of the service; who answers is `_call`."""

            async def _call(
                self,
                method: str,
                path: str,
                kind: Any,
                *,
                body: Any = None,
                query: dict[str, Any] | None = None,
                headers: dict[str, Any] | None = None,
            ) -> Any:
                raise NotImplementedError
    ''')
    for method, path, operation in _for_programs(openapi):
        if operation["operationId"] not in BY_HAND:
            yield _operation(method, path, operation)


def _operation(method: str, path: str, operation: Schema) -> str:
    parameters = [one for one in operation.get("parameters", ()) if one["name"] not in OF_THE_TRANSPORT]
    places = {kind: [one for one in parameters if one["in"] == kind] for kind in ("path", "query", "header")}
    body = operation.get("requestBody", {}).get("content", {}).get("application/json", {}).get("schema")
    takes = ["self"]
    takes += [f"{one['name']}: {_type(one['schema'])}" for one in places["path"]]
    takes += [f"wish: {_type(body)}"] if body else []
    named = places["query"] + places["header"]
    takes += ["*", *(_argument(one) for one in sorted(named, key=lambda one: not one.get("required")))] if named else []
    answered = _answered(operation)
    route = re.sub(r"{(\w+)}", r"{quote(str(\1), safe='')}", path)
    call = [repr(method.upper()), f"f{route!r}" if "{" in route else repr(route), answered or "None"]
    call += ["body=wish"] if body else []
    call += [f"query={_gathered(places['query'])}"] if places["query"] else []
    call += [f"headers={_gathered(places['header'])}"] if places["header"] else []
    said = f"await self._call({', '.join(call)})"
    last = f"answer: {answered} = {said}\n        return answer" if answered else said
    name, meaning = operation["operationId"], _paragraphs(operation["description"], 8)
    return f'\n    async def {name}({", ".join(takes)}) -> {answered}:\n        """{meaning}"""\n        {last}\n'


def _argument(parameter: Schema) -> str:
    kind = _type(parameter["schema"])
    if parameter.get("required"):
        return f"{_plain(parameter)}: {kind}"
    return f"{_plain(parameter)}: {kind}{'' if kind.endswith('None') else ' | None'} = None"


def _gathered(parameters: list[Schema]) -> str:
    return "{" + ", ".join(f"{one['name']!r}: {_plain(one)}" for one in parameters) + "}"


def _plain(parameter: Schema) -> str:
    name = str(parameter["name"]).lower().replace("-", "_")
    return f"{name}_" if iskeyword(name) else name


def _answered(operation: Schema) -> str | None:
    content = next((a.get("content", {}) for s, a in sorted(operation["responses"].items()) if s[0] == "2"), {})
    if "application/json" in content:
        return _type(content["application/json"].get("schema", {}))
    return "bytes" if content else None


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _paragraphs(text: str, indent: int) -> str:
    """A docstring: wrapped, its first paragraph first."""
    parts = ["\n".join(wrap(_one_line(part), 112 - indent)) for part in text.split("\n\n")]
    said = "\n\n".join(parts)
    margin = " " * indent
    lines = [line if not number or not line else margin + line for number, line in enumerate(said.split("\n"))]
    return "\n".join(lines) + (f"\n{margin}" if len(lines) > 1 else "")


if __name__ == "__main__":
    structlog.configure(logger_factory=structlog.PrintLoggerFactory(sys.stderr))  # stdout is the document's
    openapi = document()
    if sys.argv[1:] == ["--document"]:
        sys.stdout.write(json.dumps(openapi, indent=2) + "\n")
        sys.exit()
    if sys.argv[1:] == ["--errors"]:
        sys.stdout.write(json.dumps(all_codes()) + "\n")
        sys.exit()
    for file_name, content in made_files(openapi).items():
        (PACKAGE / file_name).write_text(content)
