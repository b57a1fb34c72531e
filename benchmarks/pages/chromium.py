"""Finds the browser that tests, pictures and benchmarks of the pages drive."""

import os
import shutil
from typing import Final

WHOLE: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
SHELL: Final = "chromium-headless-shell"
"""The same engine without a window, whose own pages cost a third of a test's time. It shows no notices, installs no
apps and sends nothing once its pages are closed."""


def find_chromium(*, whole: bool = False) -> str | None:
    """$CHROMIUM, else the first known name on the PATH; `whole`: no shell, unless there is nothing else.

    Raises:
        FileNotFoundError: $CHROMIUM is no program that can be run; it is an error, not an absence.
    """
    named = os.environ.get("CHROMIUM")
    if named and shutil.which(named) is None:
        raise FileNotFoundError(f"CHROMIUM={named} is no program that can be run")
    names = (*WHOLE, SHELL) if whole else (SHELL, *WHOLE)
    return named or next(filter(None, map(shutil.which, names)), None)
