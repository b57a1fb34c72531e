"""The kept tables are those of the grammar, and the parser that reads them agrees with Lark's own."""

import subprocess
import sys
from pathlib import Path

import pytest
from lark import Lark, LarkError

from bdi.language.parser import parse_program
from bdi.language.parser.tables import GRAMMAR, KEPT, STARTS, written

EXAMPLES = sorted((Path(__file__).parents[3] / "examples" / "agents").glob("*.asl"))


def test_the_kept_tables_are_those_of_the_grammar() -> None:
    assert KEPT.read_text() == written(GRAMMAR.read_text()), "run python -m bdi.language.parser.tables"


@pytest.fixture(scope="module")
def lark() -> Lark:
    return Lark(GRAMMAR.read_text(), parser="lalr", start=list(STARTS), maybe_placeholders=False)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_what_lark_reads_is_read_and_what_it_refuses_is_refused(lark: Lark, path: Path) -> None:
    text = path.read_text()
    lark.parse(text, start="program")
    parse_program(text)
    for end in range(0, len(text), 41):  # in the middle of everything
        assert _reads(lark, text[:end]) == _is_read(text[:end]), text[:end]


def _reads(lark: Lark, text: str) -> bool:
    try:
        lark.parse(text, start="program")
    except LarkError:
        return False
    return True


def _is_read(text: str) -> bool:
    from bdi import AgentSpeakError

    try:
        parse_program(text)
    except AgentSpeakError:
        return False
    return True


def test_a_program_is_read_without_lark() -> None:
    script = "import sys; from bdi import *; a = Agent(parse_program('!a. +!a <- act.')); assert a.cycle().actions; "
    subprocess.run([sys.executable, "-c", f"{script} assert 'lark' not in sys.modules"], check=True)
