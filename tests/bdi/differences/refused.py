"""Not supported: refused by name, with the way out."""

import pytest

from bdi import Agent, UnknownInternalAction, parse_program
from tests.bdi.differences import shows


@shows("list_files")
def list_files() -> None:
    with pytest.raises(UnknownInternalAction, match="an agent reads no files"):
        Agent(parse_program("+!never <- .list_files(F)."))


@shows("join")
def join() -> None:
    with pytest.raises(UnknownInternalAction, match=r"it is a part of \.fork"):
        Agent(parse_program("+!never <- .join(a)."))


@shows("java")
def java() -> None:
    with pytest.raises(UnknownInternalAction, match="there is no internal action mylib"):
        Agent(parse_program("+!g : mylib.test(1) <- p."))
