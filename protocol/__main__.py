"""`python -m protocol` prints every message with its examples, `--asyncapi` all of them as an AsyncAPI document."""

import inspect
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from protocol import asyncapi
from protocol.envelope import BOTH_WAYS, DURABLE, TO_ROBOT, TO_SERVER, parse
from protocol.example_files import examples_of
from protocol.parts import Part

CHECKOUT = Path(__file__).parents[1]

DIRECTIONS: Mapping[str, Mapping[str, type[Part]]] = {
    "Robot to server": {name: kind for name, kind in TO_SERVER.items() if name not in BOTH_WAYS},
    "Server to robot": {name: kind for name, kind in TO_ROBOT.items() if name not in BOTH_WAYS},
    "Both ways": BOTH_WAYS,
}


def messages_as_markdown() -> str:
    """One section per direction, one part per message: what it means, whether it is kept, its example files."""
    return "".join(_lines())


def _lines() -> Iterator[str]:
    for direction, messages in DIRECTIONS.items():
        yield f"## {direction}\n\n"
        for name, kind in messages.items():
            yield f"### {name}\n\n{inspect.cleandoc(kind.__doc__ or '')}\n\n"
            yield _kept(name)
            for path in examples_of(name):
                parse(path.read_bytes(), {name: kind})
                yield f"`{path.relative_to(CHECKOUT)}`\n\n```json\n{path.read_text()}```\n\n"


def _kept(name: str) -> str:
    if name in DURABLE:
        return "*Durable*: numbered, kept on disk, sent again until it is acknowledged.\n\n"
    return "Not kept: carries no `seq`.\n\n"


if __name__ == "__main__":
    if sys.argv[1:] == ["--asyncapi"]:
        print(asyncapi.as_text(), end="")
    else:
        print(messages_as_markdown(), end="")
