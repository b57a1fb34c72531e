"""A checkout of a test's own, in which `make` may do what it likes."""

import os
import shutil
import subprocess
from pathlib import Path

CHECKOUT = Path(__file__).parent.parent


def copied_to(folder: Path) -> Path:
    """As much of a checkout as set-up reads first."""
    folder.mkdir(exist_ok=True)
    for name in ("Makefile", "pyproject.toml", "constraints.txt"):
        shutil.copy(CHECKOUT / name, folder)
    return folder


def make(checkout: Path, *words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["make", *words],
        cwd=checkout,
        env={"PATH": os.environ["PATH"], "HOME": str(checkout), **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=110,
    )


def sentences(finished: subprocess.CompletedProcess[str]) -> list[str]:
    """Return the lines of the error, without make's own."""
    return [line for line in finished.stderr.splitlines() if not line.startswith("make: ***")]
