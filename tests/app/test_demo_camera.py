"""In a demonstration the page holds a person's own code to the simulated robot's camera."""

import json
import socketserver
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from app.core.settings import Settings
from tests.app.conftest import Browser, Mailroom


class Door:
    """The simulated world's door, as far as the service knocks at it: strict about what it takes."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.asked: list[dict[str, Any]] = []
        door = self

        class Visitor(socketserver.StreamRequestHandler):
            def handle(self) -> None:
                for line in self.rfile:
                    self.wfile.write(json.dumps(door.answer(json.loads(line))).encode() + b"\n")

        self.server = socketserver.ThreadingUnixStreamServer(str(path), Visitor)

    def answer(self, wish: dict[str, Any]) -> dict[str, Any]:
        self.asked.append(wish)
        if set(wish) != {"do", "text"} or wish["do"] != "show_code" or not wish["text"].startswith("CM1:"):
            return {"ok": False, "error": f"cannot {wish}"}
        return {"ok": True}


@pytest.fixture
def door() -> Iterator[Door]:
    with tempfile.TemporaryDirectory(prefix="cm-") as folder:  # socket paths are short
        door = Door(Path(folder) / "r1")  # as the robot that has the order is called
        thread = threading.Thread(target=door.server.serve_forever, args=(0.05,))
        thread.start()
        yield door
        door.server.shutdown()
        door.server.server_close()
        thread.join()


@pytest.fixture(params=["one door", "a folder of doors"])
def settings(settings: Settings, door: Door, request: pytest.FixtureRequest) -> Settings:
    where = door.path if request.param == "one door" else door.path.parent
    return settings.model_copy(update={"demo_door": where})


@pytest.fixture
def order_id(sender: Browser) -> str:
    return str(sender.order().json()["id"])


def test_the_sender_shows_their_own_code(sender: Browser, mailroom: Mailroom, door: Door, order_id: str) -> None:
    mailroom.move(order_id, "assigned", "to_sender", "at_sender")
    answer = sender.post("/api/v1/demo/camera", json={"order_id": order_id})
    assert (answer.status_code, answer.json()) == (202, {"purpose": "load"})
    shown = sender.get(f"/api/v1/orders/{order_id}/code").json()["text"]
    assert door.asked == [{"do": "show_code", "text": shown}]
    assert sender.get("/api/v1/about").json()["demo"] is True


def test_no_person_shows_a_code_out_of_turn(recipient: Browser, mailroom: Mailroom, door: Door, order_id: str) -> None:
    mailroom.move(order_id, "assigned", "to_sender", "at_sender")
    answer = recipient.post("/api/v1/demo/camera", json={"order_id": order_id})
    assert (answer.status_code, answer.json()["code"]) == (404, "no_code")
    assert door.asked == []


def test_a_robot_that_is_gone_is_named(sender: Browser, mailroom: Mailroom, door: Door, order_id: str) -> None:
    mailroom.move(order_id, "assigned")
    door.path.unlink()
    answer = sender.post("/api/v1/demo/camera", json={"order_id": order_id})
    assert (answer.status_code, answer.json()["code"]) == (409, "door_closed")
