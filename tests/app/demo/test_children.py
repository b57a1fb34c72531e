"""The processes of a demonstration: watched while they run, ended by their ids, and none is left behind."""

import asyncio
import sys
import time
from pathlib import Path

import psutil
import pytest

from app.demo.children import STOP_WITHIN_S, Children
from app.demo.settings import DemoFailed

STUBBORN = (
    "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print('here', flush=True); time.sleep(60)"
)


def python(program: str) -> list[str]:
    return [sys.executable, "-c", program]


async def test_a_child_that_dies_is_named_with_its_last_words(tmp_path: Path) -> None:
    children = Children()
    child = await children.start("robot", python("print('no battery'); raise SystemExit(3)"), tmp_path / "log")
    with pytest.raises(DemoFailed, match=r"(?s)The robot ended with exit code 3\..*no battery"):
        await child.watch()
    await children.stop()


async def test_all_children_are_stopped_at_once_even_those_that_do_not_listen(tmp_path: Path) -> None:
    children = Children()
    started = [await children.start(f"child {n}", python(STUBBORN), tmp_path / f"log{n}") for n in (1, 2)]
    while not all(child.log.read_text() for child in started):  # noqa: ASYNC110  # they are other processes
        await asyncio.sleep(0.02)
    began_s = time.monotonic()
    await children.stop()
    assert time.monotonic() - began_s < STOP_WITHIN_S + 1.0
    assert not any(psutil.pid_exists(child.process.pid) for child in started)
