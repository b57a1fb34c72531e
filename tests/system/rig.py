"""The real processes of a delivery, and two simulated people who use the service as a browser would."""

import contextlib
import json
import math
import os
import re
import signal
import socket
import subprocess
import sys
import time
import uuid
from collections.abc import Callable
from email import message_from_bytes, policy
from pathlib import Path
from typing import Any, TypeVar

import httpx

from protocol.clock import SharedClock
from tests.system.proxy import CuttableWire

T = TypeVar("T")
ROOT = Path(__file__).parents[2]
SENDER, RECIPIENT = "sender@campus.example", "recipient@campus.example"
ENDED = {"delivered", "cancelled", "expired", "returned", "attention"}


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_for(what: str, look: Callable[[], T | None], limit_s: float = 60.0, every_s: float = 0.05) -> T:
    """Look until there is something to see; AssertionError naming `what` after `limit_s`."""
    until_s = time.monotonic() + limit_s
    while time.monotonic() < until_s:
        if (seen := look()) is not None and seen is not False:
            return seen
        time.sleep(every_s)
    raise AssertionError(f"waited {limit_s:.0f} s in vain: {what}")


class Person:
    """A person signed in with a code from their mail."""

    def __init__(self, email: str, base_url: str, spool: Path) -> None:
        self.email = email
        headers = {"Sec-Fetch-Site": "same-origin"}
        self._http = httpx.Client(base_url=base_url, headers=headers, timeout=20, verify=False)  # noqa: S501  # no https
        self._spool = spool

    def leave(self) -> None:
        self._http.close()

    def sign_in(self) -> None:
        self._http.post("/api/v1/sign-in/codes", json={"email": self.email}).raise_for_status()
        code = wait_for("the mailed code", self._mailed_code)
        self._http.post("/api/v1/sign-in", json={"email": self.email, "code": code}).raise_for_status()

    def _mailed_code(self) -> str | None:
        for mail in self.mails():
            if mail["To"] == self.email and (found := re.search(r"\b(\d{8})\b", mail.get_content())):
                return found.group(1)
        return None

    def mails(self) -> list[Any]:
        files = sorted(self._spool.glob("**/*.eml"), key=lambda file: file.stat().st_mtime, reverse=True)
        mails = [message_from_bytes(file.read_bytes(), policy=policy.default) for file in files]
        return [mail for mail in mails if mail["To"] == self.email]

    def get(self, path: str) -> Any:
        return self._http.get(f"/api/v1{path}").raise_for_status().json()

    def post(self, path: str, body: dict[str, Any] | None = None) -> httpx.Response:
        return self._http.post(f"/api/v1{path}", json=body or {})

    def delete(self, path: str) -> None:
        self._http.delete(f"/api/v1{path}").raise_for_status()

    def order(self, from_post: str, to_post: str, recipient: str) -> str:
        body = {"from_post": from_post, "to_post": to_post, "recipient": recipient, "description": "A letter"}
        answer = self._http.post("/api/v1/orders", json=body, headers={"Idempotency-Key": str(uuid.uuid4())})
        assert answer.status_code == httpx.codes.CREATED, answer.text
        return str(answer.json()["id"])

    def notices(self) -> list[str]:
        return sorted(notice["kind"] for notice in self.get("/notices")["items"])


class Rig:
    """A service and a simulated robot in processes of their own, joined by a wire that can be cut."""

    def __init__(self, folder: Path, speed: float) -> None:
        self.folder = folder
        self.clock_file = folder / "clock"
        self.settings_file = folder / "robot.toml"
        self.clock = SharedClock.create(self.clock_file, speed)
        self.port = free_port()
        self.base_url = f"http://127.0.0.1:{self.port}"
        self.wire = CuttableWire(self.port)
        self.processes: dict[str, subprocess.Popen[bytes]] = {}
        self.people: list[Person] = []
        self.door = Path(f"/tmp/campus-mail-door-{uuid.uuid4().hex[:12]}")  # socket paths are short

    def __enter__(self) -> "Rig":
        self.wire.__enter__()
        self.start_service()
        self.enrol()
        self.start_robot()
        return self

    def enrol(self) -> None:
        """Enrol as a maintainer and a technician at the robot do it: one makes a code, the other types it."""
        code = self._command(["app", "robots", "enrol", "r1"], self._service_env())
        ran = self.type_code("r1", code, self.settings_file)
        assert ran.returncode == 0, ran.stderr
        settings = self.settings_file.read_text()  # the robot speaks through the wire that can be cut
        settings = settings.replace(f":{self.port}/", f":{self.wire.port}/")
        self.settings_file.write_text('home = "post5_bay1"\n' + settings)

    def type_code(self, name: str, code: str, settings_file: Path) -> subprocess.CompletedProcess[str]:
        """Run `robot enrol` with a code."""
        server = f"ws://127.0.0.1:{self.port}/api/v1/robots/link"
        enrol = [sys.executable, "-m", "robot", "enrol", name, server, "--config", str(settings_file), "--code-stdin"]
        return subprocess.run(enrol, check=False, cwd=ROOT, input=code, capture_output=True, text=True)

    def _command(self, arguments: list[str], env: dict[str, str]) -> str:
        ran = subprocess.run(
            [sys.executable, "-m", *arguments], cwd=ROOT, env=env, check=True, capture_output=True, text=True
        )
        return ran.stdout.strip()

    def __exit__(self, *_: object) -> None:
        for person in self.people:
            person.leave()
        try:
            for name in ("robot", "service"):
                self.stop(name)
        finally:
            for name in list(self.processes):
                self.kill(name)
            self.wire.__exit__()
            self.door.unlink(missing_ok=True)

    def sign_in(self, email: str) -> Person:
        """Sign a person in with the code from the spool of mails."""
        person = Person(email, self.base_url, self.folder / "service" / "spool")
        self.people.append(person)
        person.sign_in()
        return person

    def sign_in_as(self, email: str, role: str) -> Person:
        """Sign in a person who has been given a role at the service's terminal."""
        self._command(["app", "people", "role", email, "--add", role], self._service_env())
        return self.sign_in(email)

    def _service_env(self) -> dict[str, str]:
        return {
            **os.environ,
            "CAMPUS_MAIL_DATA": str(self.folder / "service"),
            "CAMPUS_MAIL_CLOCK_FILE": str(self.clock_file),
            "CAMPUS_MAIL_ALLOWED_DOMAINS": '["campus.example"]',
            "CAMPUS_MAIL_MAP": "test_track",
        }

    def _start(self, name: str, arguments: list[str], env: dict[str, str]) -> None:
        with (self.folder / f"{name}.log").open("ab") as log:
            command = [sys.executable, "-m", *arguments]
            self.processes[name] = subprocess.Popen(command, cwd=ROOT, env=env, stdout=log, stderr=log)

    def start_service(self) -> None:
        self._start("service", ["app", "serve", "--port", str(self.port)], self._service_env())
        wait_for("the service answers", self._service_is_ready)

    def _service_is_ready(self) -> bool:
        assert self.processes["service"].poll() is None, self.log("service")
        with contextlib.suppress(httpx.HTTPError):
            return httpx.get(f"{self.base_url}/readyz", verify=False).is_success  # noqa: S501  # no https
        return False

    def start_robot(self) -> None:
        arguments = ["robot", "--simulated", "--config", str(self.settings_file), "--data", str(self.folder / "robot")]
        arguments += ["--clock", str(self.clock_file), "--door", str(self.door)]
        if not (self.folder / "robot").exists():  # later it is where it was
            arguments += ["--start", "dock:post5"]
        self._start("robot", arguments, dict(os.environ))

    def stop(self, name: str) -> None:
        if name in self.processes:
            self.processes[name].send_signal(signal.SIGTERM)
            self.processes[name].wait(10)
            del self.processes[name]

    def kill(self, name: str) -> None:
        """SIGKILL: no chance to tidy up."""
        process = self.processes.pop(name)
        process.kill()
        process.wait()

    def log(self, name: str) -> str:
        return (self.folder / f"{name}.log").read_text(errors="replace")[-4000:]

    def let_pass(self, duration_s: float) -> None:
        """Seconds of the clock that service and robot share."""
        until_s = self.clock.now() + duration_s
        wait_for(f"{duration_s:.0f} s pass", lambda: self.clock.now() >= until_s)

    def at_the_door(self, command: dict[str, Any]) -> dict[str, Any]:
        with socket.socket(socket.AF_UNIX) as door:
            door.settimeout(10)
            door.connect(str(self.door))
            door.sendall(json.dumps(command).encode() + b"\n")
            answer: dict[str, Any] = json.loads(door.makefile().readline())
        assert answer["ok"], answer
        return answer

    def stands_at(self, x_m: float, y_m: float, within_m: float = 0.4) -> bool:
        """Return whether the simulated robot stands still near a place."""
        before = self._pose()
        time.sleep(0.2)
        return self.is_near(x_m, y_m, within_m) and self.is_near(*before, within_m=0.005)

    def is_near(self, x_m: float, y_m: float, within_m: float = 0.4) -> bool:
        """Return whether the simulated robot is at a place or passes it."""
        here_x_m, here_y_m = self._pose()
        return math.hypot(here_x_m - x_m, here_y_m - y_m) < within_m

    def _pose(self) -> tuple[float, float]:
        pose = self.at_the_door({"do": "state"})["pose"]
        return pose["x_m"], pose["y_m"]

    def wait_for_state(self, person: Person, order_id: str, state: str, limit_s: float = 90.0) -> dict[str, Any]:
        """Follow the order until it has been in `state`; an order that ended otherwise is told at once."""

        def look() -> dict[str, Any] | None:
            for name, process in self.processes.items():
                assert process.poll() is None, f"{name} ended:\n{self.log(name)}"
            with contextlib.suppress(httpx.TransportError):
                order: dict[str, Any] = person.get(f"/orders/{order_id}")
                if state in [event["state"] for event in order["events"]]:
                    return order
                assert order["state"] not in ENDED, f"ended {order['state']}\n{self.log('robot')}"
            return None

        # Not more often: to be asked takes the service a share of what the simulation needs, too.
        return wait_for(f"{order_id} {state}\n{self.log('robot')}", look, limit_s, every_s=0.2)

    def show_code(self, person: Person, order_id: str) -> None:
        """The person holds their hand-over code to the robot's camera."""
        self.at_the_door({"do": "show_code", "text": person.get(f"/orders/{order_id}/code")["text"]})
