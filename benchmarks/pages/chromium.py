"""Finds the browser that tests, pictures and benchmarks of the pages drive."""

import os
import shutil
from typing import Final

NAMES: Final = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
"""The shell first: the same engine without a window, whose own pages cost a third of a test's time."""


def find_chromium() -> str | None:
    """$CHROMIUM, else the first known name on the PATH.

    Raises:
        FileNotFoundError: $CHROMIUM is no program that can be run; it is an error, not an absence.
    """
    named = os.environ.get("CHROMIUM")
    if named and shutil.which(named) is None:
        raise FileNotFoundError(f"CHROMIUM={named} is no program that can be run")
    return named or next(filter(None, map(shutil.which, NAMES)), None)
