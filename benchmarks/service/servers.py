"""The programs that are measured, each a process of its own on the server's core."""

import json
import os
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

CHECKOUT: Final = Path(__file__).parents[2]
SERVER_CORE: Final = 0
LOAD_CORE: Final = 1
STARTS_WITHIN_S: Final = 60.0
MAP: Final = "carleton"


class DidNotStart(Exception):
    """A program that was to be measured did not answer."""


@dataclass(frozen=True)
class Server:
    """A running program."""

    port: int
    process: subprocess.Popen[bytes]
    log: Path

    @property
    def link_url(self) -> str:
        return f"ws://127.0.0.1:{self.port}/api/v1/robots/link"

    def health(self) -> None:
        """Ask how it is, and wait for the answer. Raises OSError."""
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/healthz", timeout=60) as answer:
            json.load(answer)

    def memory_mib(self) -> dict[str, float]:
        """Resident memory now, and the most it has ever been."""
        lines = Path(f"/proc/{self.process.pid}/status").read_text().splitlines()
        kib = {name: int(rest.split()[0]) for name, _, rest in (line.partition(":") for line in lines) if "kB" in rest}
        return {"rss_mib": round(kib["VmRSS"] / 1024, 1), "rss_peak_mib": round(kib["VmHWM"] / 1024, 1)}

    def processor_s(self) -> float:
        """Return the core time that it has used since its start."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def service(data: Path, **more: str) -> Iterator[Server]:
    """The service as people run it, with its data in this folder, and with these settings besides."""
    port = free_port()
    names = {
        "DATA": str(data),
        "MAP": MAP,
        "LOG_LEVEL": "WARNING",
        "RATE_LIMITS": '{"orders_per_person": "1000000 per hour"}',
        **more,
    }
    environment = {f"CAMPUS_MAIL_{name}": value for name, value in names.items()}
    with _running(["app", "serve", "--port", str(port)], port, data / "service.log", environment) as server:
        yield server


@contextmanager
def bare(data: Path) -> Iterator[Server]:
    """Run the baseline server."""
    data.mkdir(parents=True, exist_ok=True)
    port = free_port()
    command = ["benchmarks.service.bare", str(data / "bare.sqlite"), str(port)]
    with _running(command, port, data / "bare.log", {}) as server:
        yield server


@contextmanager
def _running(command: list[str], port: int, log: Path, environment: dict[str, str]) -> Iterator[Server]:
    pinned = [sys.executable, "-m", "benchmarks.service.pinned", str(SERVER_CORE), *command]
    with log.open("wb") as file:
        process = subprocess.Popen(pinned, cwd=CHECKOUT, env={**os.environ, **environment}, stdout=file, stderr=file)
    server = Server(port, process, log)
    try:
        _wait_until_it_answers(server)
        yield server
    finally:
        process.terminate()
        with suppress(subprocess.TimeoutExpired):
            process.wait(15)
        if process.poll() is None:
            process.kill()
            process.wait()


def _wait_until_it_answers(server: Server) -> None:
    end_s = time.monotonic() + STARTS_WITHIN_S
    while time.monotonic() < end_s and server.process.poll() is None:
        with suppress(OSError):
            server.health()
            return
        time.sleep(0.05)
    raise DidNotStart(server.log.read_text(errors="replace")[-2000:])


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        return int(listening.getsockname()[1])
