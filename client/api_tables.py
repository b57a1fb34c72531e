"""The tables of docs/reference/api.md that follow from the API document: every error, every operation."""

from pathlib import Path
from typing import Any, Final

from app.http.api_document import all_codes, operations

HEAD: Final = "| request | name | | opened by |\n|---|---|---|---|\n"
PAGE: Final = Path(__file__).parents[1] / "docs" / "reference" / "api.md"


def page(openapi: dict[str, Any]) -> str:
    """docs/reference/api.md with its tables as they are now."""
    text = PAGE.read_text()
    for name, table in (("errors", _errors()), ("operations", _operations(openapi))):
        begin, end = f"<!-- {name}: make client -->\n", f"<!-- end of {name} -->\n"
        before, _, rest = text.partition(begin)
        text = before + begin + table + end + rest.partition(end)[2]
    return text


def _errors() -> str:
    rows = [f"| `{code}` | {status} | {meaning} |\n" for code, (status, meaning) in all_codes().items()]
    return "| `code` | status | meaning |\n|---|---|---|\n" + "".join(rows)


def _operations(openapi: dict[str, Any]) -> str:
    by_tag: dict[str, list[str]] = {tag["name"]: [] for tag in openapi["tags"]}
    for method, path, operation in operations(openapi):
        said = f"`{method.upper()} {path.removeprefix('/api/v1')}`"
        row = f"| {said} | `{operation['operationId']}` | {operation['summary']} | {_opened_by(operation)} |\n"
        by_tag[operation["tags"][0]].append(row)
    meanings = {tag["name"]: tag["description"] for tag in openapi["tags"]}
    used = [(tag, "".join(rows)) for tag, rows in by_tag.items() if rows]
    return "".join(f"### {tag.capitalize()}\n{meanings[tag]}\n\n{HEAD}{rows}\n" for tag, rows in used)


def _opened_by(operation: dict[str, Any]) -> str:
    if "security" not in operation:
        return "open"
    scopes = [scope for way in operation["security"] for scope in way.get("token", ())]
    return " ".join(f"`{scope}`" for scope in scopes) or "browser"
