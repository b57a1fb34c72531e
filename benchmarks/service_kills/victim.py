"""The real service as a process of its own, killed and started again on the same port and the same data."""

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import httpx

from maps.campus_map import map_path
from maps.map_file import load_map_file, toml_of
from maps.scaling import scaled

CHECKOUT: Final = Path(__file__).parents[2]
STARTS_WITHIN_S: Final = 180.0
ENDS_WITHIN_S: Final = 15.0


MAP: Final = "test_track"
SCALE: Final = 0.02
"""A campus that fits on a table: robots drive as fast as their base can, and are there in a moment all the same."""


class DidNotStart(Exception):
    """The service did not answer; what it said last."""


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        return int(listening.getsockname()[1])


@dataclass
class Victim:
    """`smtp_port` None: mails are files in the spool."""

    folder: Path
    smtp_port: int | None = None
    port: int = field(default_factory=free_port)
    process: "subprocess.Popen[bytes] | None" = None

    def __post_init__(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        self.map_file = self.folder / "table_top.toml"
        self.map_file.write_text(toml_of(scaled(load_map_file(map_path(MAP)), SCALE)), encoding="utf-8")

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def link_url(self) -> str:
        return f"ws://127.0.0.1:{self.port}/api/v1/robots/link"

    def environment(self) -> dict[str, str]:
        """Settings of the environment that would lead elsewhere are left out."""
        ours = {
            "CAMPUS_MAIL_DATA": str(self.folder / "data"),
            "CAMPUS_MAIL_MAP": str(self.map_file),
            "CAMPUS_MAIL_PUBLIC_URL": "https://mail.campus.example",
            "CAMPUS_MAIL_RATE_LIMITS": json.dumps(
                {"sign_in_codes_per_address": "1000 per minute", "orders_per_person": "1000000 per hour"}
            ),
            "CAMPUS_MAIL_LOG_LEVEL": "WARNING",
        }
        if self.smtp_port is not None:
            ours |= {"CAMPUS_MAIL_SMTP_HOST": "127.0.0.1", "CAMPUS_MAIL_SMTP_PORT": str(self.smtp_port)}
            ours |= {"CAMPUS_MAIL_SMTP_TLS": "none"}
        inherited = {name: value for name, value in os.environ.items() if not name.startswith("CAMPUS_MAIL_")}
        return {**inherited, **ours}

    def start(self) -> None:
        with (self.folder / "service.log").open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "app", "serve", "--port", str(self.port)],
                cwd=CHECKOUT, env=self.environment(), stdout=log, stderr=log,
            )  # fmt: skip

    async def is_up(self) -> None:
        """Wait until it answers. Raises DidNotStart."""
        assert self.process is not None
        with suppress(TimeoutError):
            async with asyncio.timeout(STARTS_WITHIN_S), httpx.AsyncClient() as http:
                while self.process.poll() is None:
                    with suppress(httpx.HTTPError):
                        if (await http.get(f"{self.url}/healthz")).is_success:
                            return
                    await asyncio.sleep(0.02)
        raise DidNotStart((self.folder / "service.log").read_text(errors="replace")[-3000:])

    def kill(self) -> None:
        """At once, as a power cut of the process would."""
        assert self.process is not None
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    async def stop(self) -> int:
        """As an operator does; the exit code."""
        assert self.process is not None
        self.process.terminate()
        return await asyncio.to_thread(self.process.wait, ENDS_WITHIN_S)

    def end(self) -> None:
        """Whatever happened: nothing is left running."""
        if self.process is not None and self.process.poll() is None:
            self.kill()
