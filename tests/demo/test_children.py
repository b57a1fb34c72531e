"""The processes of a demonstration: watched while they run, ended by their ids, and none is left behind."""

import asyncio
import sys
import time
from pathlib import Path

import psutil
import pytest

from app.core.settings import ROOT
from demo.children import STOP_WITHIN_S, Children
from demo.settings import DemoFailed

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


PARENT = """
import asyncio, pathlib, sys
from demo.children import Children

async def main():
    command = [sys.executable, "-c", "import time; time.sleep(60)"]
    child = await Children().start("robot", command, pathlib.Path(sys.argv[1]))
    print(child.process.pid, flush=True)
    await asyncio.sleep(60)

asyncio.run(main())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel's own way")
@pytest.mark.slow
async def test_a_demonstration_that_is_killed_leaves_no_children_behind(tmp_path: Path) -> None:
    parent = await asyncio.create_subprocess_exec(
        *python(PARENT), str(tmp_path / "log"), stdout=asyncio.subprocess.PIPE, cwd=ROOT
    )
    assert parent.stdout is not None
    child = psutil.Process(int(await parent.stdout.readline()))
    parent.kill()
    await parent.wait()
    psutil.wait_procs([child], timeout=10)
    assert not child.is_running()
