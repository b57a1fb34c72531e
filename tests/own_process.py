"""Count a whole process's objects, memory or threads in a process of its own: in one that other tests have
used, theirs come and go as well."""

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import TypeVar

Found = TypeVar("Found")


def in_own_process(counted: Callable[[], Found]) -> Found:
    """Return the result of a test module's function in a fresh process. What it raises is raised here."""
    with ProcessPoolExecutor(max_workers=1, mp_context=get_context("spawn")) as processes:
        return processes.submit(counted).result()
