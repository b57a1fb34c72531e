"""Packages to run are fetched apart from those that tests need, and an error in set-up is one sentence."""

import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.metadata import packages_distributions, requires
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.own_checkout import CHECKOUT, copied_to, make, sentences

UNPRIVILEGED_ID = 65534
PROJECT: dict[str, Any] = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
EXTRAS: dict[str, list[str]] = PROJECT["optional-dependencies"]


# What keeps it from its work


@pytest.fixture
def read_only() -> Iterator[Path]:
    """A checkout that others may read."""
    with tempfile.TemporaryDirectory() as folder:
        checkout = copied_to(Path(folder) / "checkout")
        for path in (Path(folder), checkout):
            path.chmod(0o555)
        yield checkout
        for path in (Path(folder), checkout):
            path.chmod(0o755)


@pytest.mark.parametrize("verb", ["demo", "setup-robot", "test"])
def test_a_checkout_that_cannot_be_written_to_is_one_sentence(read_only: Path, verb: str) -> None:
    # Permissions do not stop root: make runs as another user.
    as_another_user = (
        {"user": UNPRIVILEGED_ID, "group": UNPRIVILEGED_ID, "extra_groups": []} if os.geteuid() == 0 else {}
    )
    finished = subprocess.run(  # type: ignore[call-overload]
        ["make", verb],
        **{"cwd": read_only, "env": {"PATH": os.environ["PATH"]}, "capture_output": True, "text": True},
        **{"timeout": 60, **as_another_user},
        check=False,
    )
    assert finished.returncode != 0
    (said,) = sentences(finished)
    assert said.startswith(f"{read_only} cannot be written to, and set-up puts the packages there")
    assert finished.stdout == ""


class ClosingIndex:
    """A package index that hangs up on everybody, and counts them."""

    def __init__(self) -> None:
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._socket.getsockname()[1]}/simple/"
        self.asked = 0
        threading.Thread(target=self._hang_up, daemon=True).start()

    def _hang_up(self) -> None:
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:
                return
            self.asked += 1
            connection.close()

    def close(self) -> None:
        self._socket.close()


@pytest.fixture
def closing_index() -> Iterator[ClosingIndex]:
    index = ClosingIndex()
    yield index
    index.close()


@pytest.mark.nightly
def test_without_a_network_it_says_so_after_one_try(tmp_path: Path, closing_index: ClosingIndex) -> None:
    nothing_else = {"PIP_CONFIG_FILE": os.devnull, "PIP_NO_CACHE_DIR": "1", "no_proxy": "127.0.0.1"}
    finished = make(
        copied_to(tmp_path / "checkout"), "demo", PYTHON=sys.executable, PIP_INDEX_URL=closing_index.url, **nothing_else
    )
    assert finished.returncode != 0
    assert finished.stdout.splitlines() == ["Making .venv …", "Fetching the Python packages that run, some 120 MB …"]
    (said,) = sentences(finished)
    assert said.startswith("The packages could not be fetched: is this machine online?")
    assert closing_index.asked == 1
    assert (tmp_path / "checkout" / said.rpartition(" ")[2]).read_text(), "it is kept what pip said"


# What is fetched for what


def planned(tmp_path: Path, verb: str) -> str:
    """Return the steps that `make` would run in a new checkout."""
    return make(copied_to(tmp_path / "checkout"), "--dry-run", verb).stdout


@pytest.mark.parametrize("verb", ["setup", "demo", "fleet-demo", "serve"])
def test_what_runs_is_set_up_without_what_tests_need(tmp_path: Path, verb: str) -> None:
    plan = planned(tmp_path, verb)
    assert "pip install" in plan
    assert "--omit=dev" in plan
    assert "develop" not in plan


@pytest.mark.parametrize("verb", ["setup-develop", "test", "check", "bench", "pages"])
def test_tests_and_tools_are_set_up_with_all_of_it(tmp_path: Path, verb: str) -> None:
    plan = planned(tmp_path, verb)
    assert re.search(r"\bservice robot develop > \.venv/requirements\.txt", plan)
    assert "npm ci" in plan
    assert "--omit=dev" not in plan


def closure(of: list[str]) -> set[str]:
    """The names of these packages and of all that they need here."""
    names, waiting = set[str](), [Requirement(text) for text in of]
    for one in waiting:
        name = canonicalize_name(one.name)
        if name in names:
            continue
        names.add(name)
        for text in requires(name) or ():
            needed = Requirement(text)
            if needed.marker is None or any(needed.marker.evaluate({"extra": extra}) for extra in ("", *one.extras)):
                waiting.append(needed)
    return names


IMPORT = re.compile(r"^\s*(?:import|from)\s+([A-Za-z_]\w*)", re.MULTILINE)
"""Also a late one."""
LATE_EXTRAS = {"asyncpg", "lgpio"}
"""Needed by settings that name them: a PostgreSQL database, the pins of a Raspberry Pi."""


@cache
def distributions_of() -> Mapping[str, list[str]]:
    """Module → the packages that bring it; to find out takes half a second."""
    return packages_distributions()


ROBOTS = ("bdi", "maps", "protocol", "robot")
"""What runs on a robot's own computer."""


def imported(*packages: str) -> set[tuple[str, str]]:
    """Others' modules that are imported, and where."""
    distributions = distributions_of()
    return {
        (name, module.relative_to(CHECKOUT).as_posix())
        for package in packages
        for module in (CHECKOUT / package).rglob("*.py")
        for name in IMPORT.findall(module.read_text(encoding="utf-8"))
        if name in distributions and name not in LATE_EXTRAS
    }


def not_among(names: set[str], modules: set[tuple[str, str]]) -> set[tuple[str, str]]:
    distributions = distributions_of()
    return {one for one in modules if names.isdisjoint(map(canonicalize_name, distributions[one[0]]))}


def test_a_server_gets_what_the_service_imports_and_nothing_of_a_robots_hardware() -> None:
    foreign = imported("app", "fleet", "maps", "protocol")
    there = closure(PROJECT["dependencies"] + EXTRAS["service"])
    assert not_among(there, foreign) == {("cv2", "maps/sheets.py")}, "for sheets with AprilTags alone"
    assert not there & {"opencv-python-headless", "pyserial", "gpiozero", "zxing-cpp"}


def test_what_runs_imports_nothing_that_only_tests_are_set_up_with() -> None:
    foreign = imported("app", *ROBOTS)
    assert {"fastapi", "cv2", "lark"} <= {name for name, _ in foreign}
    assert not_among(closure(PROJECT["dependencies"] + EXTRAS["service"] + EXTRAS["robot"]), foreign) == set()


def test_a_robots_computer_gets_what_its_programs_import_and_nothing_of_the_service(tmp_path: Path) -> None:
    plan = planned(tmp_path, "setup-robot")
    assert re.search(r"\brobot pi > \.venv/requirements\.txt", plan)
    assert "service" not in plan
    foreign = imported(*ROBOTS)
    assert not_among(closure(PROJECT["dependencies"] + EXTRAS["robot"]), foreign) == set()
    needed = {canonicalize_name(one) for name, _ in foreign for one in distributions_of()[name]}
    assert {canonicalize_name(Requirement(text).name) for text in EXTRAS["robot"]} <= needed


START_WITHOUT = """
import sys
from importlib import import_module

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in sys.argv[1].split():
            raise ModuleNotFoundError(f"not on a robot: {name}", name=name)

sys.meta_path.insert(0, Missing())
for name in ("robot.__main__", "robot.scenarios.__main__", "robot.simulated.__main__", "maps.__main__", "bdi.__main__"):
    import_module(name)
"""


@pytest.mark.slow
def test_robots_programs_start_where_no_package_of_the_service_is() -> None:
    there = closure(PROJECT["dependencies"] + EXTRAS["robot"])
    absent = [name for name, homes in distributions_of().items() if there.isdisjoint(map(canonicalize_name, homes))]
    assert {"fastapi", "sqlalchemy", "uvicorn"} <= set(absent)
    command = [sys.executable, "-c", START_WITHOUT, " ".join(absent)]
    started = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, timeout=60, check=False)
    assert started.returncode == 0, started.stderr


# Pins


def test_every_package_that_is_named_is_pinned_to_a_version_that_is_allowed() -> None:
    text = (CHECKOUT / "constraints.txt").read_text()
    pins = {canonicalize_name(name): version for name, version in re.findall(r"^([\w.-]+)==(\S+)", text, re.MULTILINE)}
    for source, named in {"dependencies": PROJECT["dependencies"], **EXTRAS}.items():
        for one in map(Requirement, named):
            pin = pins.get(canonicalize_name(one.name))
            assert pin is not None, f"{one.name} ({source}) is not pinned: make pin"
            assert one.specifier.contains(pin), f"{one} ({source}) is pinned to {pin}: make pin"


def test_pins_are_renewed_for_every_extra(tmp_path: Path) -> None:
    assert {"service", "robot", "pi", "postgres", "yardstick", "node", "develop"} == EXTRAS.keys()
    command = planned(tmp_path, "pin").replace("\\\n", "")
    assert re.search(r"uv pip compile .*--all-extras .*--output-file constraints\.txt", command)
