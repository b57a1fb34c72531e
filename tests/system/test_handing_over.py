"""Every way in which mail changes hands, with the robot's own program at one end and the service at the other.

The robot is simulated, and enrolled by a one-time code as in a mailroom: its receipts are signed.
"""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.system.rig import RECIPIENT, SENDER, Person, Rig, wait_for

pytestmark = [pytest.mark.system, pytest.mark.timeout(280)]

DISPATCHER = "dispatcher@campus.example"


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path, speed=12.0) as rig:
        yield rig


def code_of(person: Person, path: str) -> dict[str, Any]:
    code: dict[str, Any] = person.get(f"{path}/code")
    return code


def show(rig: Rig, text: str) -> None:
    rig.at_the_door({"do": "show_code", "text": text})


def custody(person: Person, path: str) -> list[tuple[str, str | None]]:
    return [(one["holder"], one["how"]) for one in person.get(path)["custody"]]


@pytest.mark.nightly
def test_a_letter_goes_by_a_tap_and_six_digits_and_is_stopped_on_the_way_from_the_page(rig: Rig) -> None:
    sender, recipient = rig.sign_in(SENDER), rig.sign_in(RECIPIENT)
    desk = rig.sign_in_as(DISPATCHER, "dispatcher")
    order_id = sender.order("post1", "post4", RECIPIENT)
    path = f"/orders/{order_id}"
    rig.wait_for_state(sender, order_id, "at_sender")
    assert sender.post(f"{path}/handover").status_code == 202
    rig.wait_for_state(sender, order_id, "carrying")

    stopped = desk.post("/robots/r1/emergency-stop", {"reason": "A child plays there."}).json()["command_id"]
    wait_for("the robot says that it stands", lambda: answer_to(desk, stopped))
    still = [rig.at_the_door({"do": "state"})["pose"] for _ in range(2) if time.sleep(0.5) is None]
    assert (still[0]["x_m"], still[0]["y_m"]) == pytest.approx((still[1]["x_m"], still[1]["y_m"]), abs=0.005)
    desk.post("/robots/r1/resume")

    # A robot that stands because a person stopped it needs attention, until it goes on.
    wait_for(f"at the recipient\n{rig.log('robot')}", lambda: recipient.get(path)["state"] == "at_recipient", 150.0)
    digits = code_of(recipient, path)["digits"]
    assert desk.post(f"{path}/handover", {"digits": digits}).status_code == 202
    rig.wait_for_state(sender, order_id, "delivered")
    assert custody(sender, path) == [("sender", None), ("robot", "tap"), ("recipient", "digits")]
    details = desk.get("/robots/r1")
    assert (details["signs_receipts"], details["takes_taps"]) == (True, True)
    assert [one["name"] for one in details["alarms"] if one["name"] in ("receipt_refused", "handover_claimed")] == []
    assert [one["evidence"] for one in sender.get(path)["custody"]] == [None, "tap", "digits"]


def answer_to(desk: Person, command_id: str) -> bool:
    told = desk.get("/robots/r1/commands")["items"]
    return any(one["command_id"] == command_id and one["accepted"] for one in told)


@pytest.mark.nightly
def test_a_delegate_loads_a_revoked_one_does_not_and_what_is_recalled_goes_back_to_its_sender_by_code(rig: Rig) -> None:
    sender = rig.sign_in(SENDER)
    order_id = sender.order("post1", "post4", RECIPIENT)
    path = f"/orders/{order_id}"
    porter, other = (sender.post(f"{path}/delegates", {"name": name}).json()["id"] for name in ("Porter", "Other"))
    texts = {one: code_of(sender, f"{path}/delegates/{one}")["text"] for one in (porter, other)}
    rig.wait_for_state(sender, order_id, "at_sender")
    sender.delete(f"{path}/delegates/{other}")
    time.sleep(1.0)  # the robot hears of it
    show(rig, texts[other])
    time.sleep(1.5)
    assert sender.get(path)["state"] == "at_sender", "a code that was taken back opens nothing"
    show(rig, texts[porter])
    rig.wait_for_state(sender, order_id, "carrying")
    assert custody(sender, path)[-1] == ("robot", "code")
    assert sender.get(path)["custody"][-1]["evidence"] == "proof", "what only the shown code gives"

    rig.at_the_door({"do": "hide_code"})  # what it was loaded with would open the way back, too
    assert sender.post(f"{path}/cancel").status_code == 200
    rig.wait_for_state(sender, order_id, "at_return", limit_s=150)
    back = code_of(sender, path)
    assert back["purpose"] == "return"
    show(rig, back["text"])
    rig.wait_for_state(sender, order_id, "returned")
    assert custody(sender, path)[-1] == ("sender", "code")
    assert sender.get(path)["custody"][-1]["evidence"] == "proof"


@pytest.mark.nightly
def test_a_robot_with_a_wrong_code_is_not_enrolled_and_is_told_so_in_words(rig: Rig, tmp_path: Path) -> None:
    settings_file = tmp_path / "r2.toml"
    ran = rig.type_code("r2", "AAAA-AAAA", settings_file)
    assert (ran.returncode, "no code for this robot that is still good" in ran.stderr) == (2, True), ran.stderr
    assert "Traceback" not in ran.stderr
    assert list(tmp_path.glob("r2.*")) == []
