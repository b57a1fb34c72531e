"""Two robots that want to swap places on the track, where neither can pass: real daemons and the real service."""

import json
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from datetime import datetime
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from tests.system.rig import ROOT, Rig, wait_for

pytestmark = [pytest.mark.system, pytest.mark.alone, pytest.mark.timeout(280)]

ERRANDS = {"r1": ("post2:post3", "post4"), "r2": ("post4:post3", "post2")}
"""Where each begins, looking along which corridor, and where it is sent."""
HOMES = {"r1": "post5_bay1", "r2": "post1_bay1"}
BETWEEN = ("post2-post3", "post3-post4")
ASIDE = {"post1", "post5", "post2_bay1", "post3_bay1", "post4_bay2"}
"""Beside the line from one end to the other: to which of them a robot goes depends on which asks first."""


class SharedTrack(Rig):
    """A service, and robots that are started by the test."""

    def __enter__(self) -> "SharedTrack":
        self.wire.__enter__()
        self.start_service()
        return self

    def __exit__(self, *_: object) -> None:
        for person in self.people:
            person.leave()
        for name in list(self.processes):
            self.kill(name)
        self.wire.__exit__()

    def enrol_one(self, name: str) -> None:
        code = self._command(["app", "robots", "enrol", name], self._service_env())
        settings_file = self.folder / f"{name}.toml"
        ran = self.type_code(name, code, settings_file)
        assert ran.returncode == 0, ran.stderr
        settings_file.write_text(f'home = "{HOMES[name]}"\n{settings_file.read_text()}')

    def send(self, name: str) -> None:
        """Put down where it begins, and sent by hand."""
        (start, goal), settings_file = ERRANDS[name], self.folder / f"{name}.toml"
        arguments = ["--simulated", "--config", str(settings_file), "--data", str(self.folder / name), "--start", start]
        arguments += ["--clock", str(self.clock_file), "--achieve", f"visit({goal})", "--limit", "900", "--json"]
        with (self.folder / f"{name}.log").open("wb") as log, (self.folder / f"{name}.json").open("wb") as told:
            command = [sys.executable, "-m", "robot", *arguments]
            self.processes[name] = subprocess.Popen(command, cwd=ROOT, stdout=told, stderr=log)

    def run_of(self, name: str) -> list[str]:
        """The posts that it reached, when it has done what it was sent for and is home again."""
        status = self.processes.pop(name).wait(200)
        assert status == 0, f"{self.log(name)}\n{self.log('service')}"
        told: dict[str, Any] = json.loads((self.folder / f"{name}.json").read_text().splitlines()[-1])
        return list(told["posts"])

    def know_where_all_are(self) -> bool:
        """Return whether each of them has told the service where it stands."""
        with closing(sqlite3.connect(self.folder / "service" / "campus-mail.sqlite")) as database:
            told = database.execute("SELECT name FROM robots WHERE post IS NOT NULL AND online").fetchall()
        return {name for (name,) in told} == set(ERRANDS)

    def grants(self) -> list[tuple[str, str, datetime, datetime]]:
        """Which robot had which corridor, from when until when."""
        with closing(sqlite3.connect(self.folder / "service" / "campus-mail.sqlite")) as database:
            rows = database.execute("SELECT corridor, robot, granted_at, cleared_at FROM grants").fetchall()
        return [(row[0], row[1], *(datetime.fromisoformat(row[at]) for at in (2, 3))) for row in rows]


@pytest.fixture
def track(tmp_path: Path) -> Iterator[SharedTrack]:
    with SharedTrack(tmp_path, speed=12.0) as track:
        yield track


@pytest.mark.nightly
def test_two_robots_that_swap_places_pass_each_other_and_come_home(track: SharedTrack) -> None:
    for name in ERRANDS:
        track.enrol_one(name)
    dispatcher = track.sign_in_as("dan@campus.example", "dispatcher")
    for corridor in BETWEEN:  # until both are known of: a robot alone on the line is in no other's way
        dispatcher.post(f"/corridors/{corridor}/close", {"reason": "Two robots are put down."}).raise_for_status()
    for name in ERRANDS:
        track.send(name)
    wait_for("both have said where they are", track.know_where_all_are)
    for corridor in BETWEEN:
        dispatcher.post(f"/corridors/{corridor}/open").raise_for_status()
    posts = {name: track.run_of(name) for name in ERRANDS}
    for name, (_, goal) in ERRANDS.items():
        assert goal in posts[name], f"{name} was never there: {posts[name]}"
        assert posts[name][-1] == HOMES[name], "and then it goes home"
    assert any({*posts[name][: posts[name].index(goal)]} & ASIDE for name, (_, goal) in ERRANDS.items()), (
        f"one of them has to step aside: {posts}"
    )
    for one, other in combinations(track.grants(), 2):
        apart = one[3] <= other[2] or other[3] <= one[2]
        assert one[0] != other[0] or one[1] == other[1] or apart, f"both in one corridor: {one}, {other}"
