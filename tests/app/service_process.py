"""The service as a process of its own, and what its log says."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from app.core.settings import ROOT


@contextmanager
def serving(data: Path, log: Path, *options: str, **settings: object) -> Iterator["subprocess.Popen[bytes]"]:
    """Until the end of the block, when it is killed if it has not ended; `settings` by their names."""
    known = {f"CAMPUS_MAIL_{name.upper()}": str(value) for name, value in {"data": data, **settings}.items()}
    command = [sys.executable, "-m", "app", "serve", *options]
    with (
        log.open("wb") as file,
        subprocess.Popen(command, cwd=ROOT, env={**os.environ, **known}, stderr=file) as process,
    ):
        try:
            yield process
        finally:
            process.kill()


def said(log: Path, event: str) -> list[dict[str, Any]]:
    """Every line of the log about this event."""
    lines = [json.loads(line) for line in log.read_text().splitlines() if line.startswith("{")]
    return [line for line in lines if line["event"] == event]
