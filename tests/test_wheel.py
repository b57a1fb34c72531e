"""The wheel, installed in environments of its own, away from the checkout: what a campus installs works."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from zipfile import ZipFile

import httpx
import pytest

from tests.own_checkout import CHECKOUT
from tests.system.rig import free_port, wait_for

pytestmark = pytest.mark.timeout(400)

HARDWARE = {"opencv-python-headless", "pyserial", "gpiozero", "zxing-cpp", "numpy"}
STYLES = "/src/styles/everywhere.css"
OF_THE_SERVICE = {"fastapi", "sqlalchemy", "uvicorn", "alembic"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    before = untracked()
    _run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder, CHECKOUT)
    assert untracked() == before, "building leaves nothing behind in the checkout"
    (built,) = folder.glob("campus_mail-*.whl")
    return built


def untracked() -> str:
    return _run("git", "-C", CHECKOUT, "status", "--short", "--untracked-files=all")


class Environment:
    """A Python environment with nothing but the wheel and what it needs."""

    def __init__(self, folder: Path, wheel: Path, extras: str) -> None:
        self.folder = folder
        _run(sys.executable, "-m", "venv", folder / "env")
        self.install(wheel, extras)

    def install(self, wheel: Path, extras: str) -> None:
        pins = CHECKOUT / "constraints.txt"
        _run(self.program("pip"), "install", "--quiet", "-c", pins, f"campus-mail[{extras}] @ {wheel.as_uri()}")

    def program(self, name: str) -> Path:
        return self.folder / "env" / "bin" / name

    def run(self, name: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run a program away from the checkout; it has to end well."""
        return _ran(self.program(name), *arguments, cwd=self.folder)

    def packages(self) -> set[str]:
        listed = json.loads(_run(self.program("pip"), "list", "--format", "json", "--disable-pip-version-check"))
        return {one["name"].lower() for one in listed}

    @contextmanager
    def serving(self) -> Iterator[str]:
        """The service's address."""
        port = free_port()
        command = [self.program("campus-mail"), "serve", "--port", str(port)]
        with subprocess.Popen(command, cwd=self.folder, env=_environment(), stderr=subprocess.PIPE) as process:
            try:
                url = f"http://127.0.0.1:{port}"
                wait_for("the service answers", lambda: _answers(url))
                yield url
            finally:
                process.terminate()
                process.communicate(timeout=20)


@pytest.mark.nightly
def test_a_server_installs_the_service_alone_and_serves_pages_and_api(wheel: Path, tmp_path: Path) -> None:
    server = Environment(tmp_path, wheel, "service")
    assert server.packages() >= OF_THE_SERVICE
    assert not server.packages() & HARDWARE
    assert "Commands" in server.run("campus-mail", "--help").stdout
    assert "install-completion" in server.run("campus-mail", "--help").stdout
    with server.serving() as url:
        version = httpx.get(f"{url}/version").json()["version"]
        assert f"campus_mail-{version}-" in wheel.name
        for address in ("/", "/mailroom.html", "/npm/joined/lit.js", "/service_worker.js", STYLES):
            assert httpx.get(f"{url}{address}").status_code == 200, address
        assert httpx.get(f"{url}/api/v1/map").status_code in {200, 401}


@pytest.mark.nightly
def test_a_robots_computer_installs_the_daemon_alone_and_both_deliver_a_letter(wheel: Path, tmp_path: Path) -> None:
    robot = Environment(tmp_path, wheel, "robot")
    assert not robot.packages() & OF_THE_SERVICE
    assert robot.packages() >= HARDWARE
    assert "ok    base" in robot.run("campus-mail-robot", "doctor", "--simulated").stdout
    (tmp_path / "hello.asl").write_text('!hello. +!hello <- .print("good morning").\n')
    assert "good morning" in robot.run("agentspeak", "run", "hello.asl").stderr

    robot.install(wheel, "service")
    summary = json.loads(robot.run("campus-mail-demo", "letter", "--once", "--json", "--port", "0").stdout)
    assert summary["ok"]
    assert summary["states"][-1]["state"] == "delivered"


@pytest.mark.slow
def test_the_wheel_carries_the_licences_of_what_it_ships(wheel: Path) -> None:
    names = ZipFile(wheel).namelist()
    assert any(name.endswith("licenses/NOTICE") for name in names)
    assert any("node_modules/lit/LICENSE" in name for name in names)
    assert not [name for name in names if name.startswith(("tests/", "benchmarks/"))]


def _answers(url: str) -> bool:
    try:
        return httpx.get(f"{url}/healthz").status_code == 200
    except httpx.TransportError:
        return False


def _environment() -> dict[str, str]:
    """Nothing of the checkout or of the environment that runs the tests."""
    return {"PATH": os.defpath, "HOME": os.environ.get("HOME", "/"), "LANG": "C.UTF-8", "COLUMNS": "120"}


def _run(*command: str | Path) -> str:
    return _ran(*command).stdout


def _ran(*command: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    environment = os.environ if cwd is None else _environment()
    ran = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False, timeout=300)
    assert ran.returncode == 0, f"{command}: {ran.stderr[-2000:]}"
    return ran
