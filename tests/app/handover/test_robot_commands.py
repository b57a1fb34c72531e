"""A dispatcher's commands to robots and what they see of one: answers, alarms, a clock that is off."""

from datetime import datetime, timedelta

import pytest

from app.models import RobotCommand, Role
from app.robots.link.clocks import has_been_set
from protocol.clock import SteppedClock
from protocol.to_robot import Confirm
from protocol.to_server import CommandAnswer, Event, Fault, Step
from tests.app.handover.conftest import Campus

KINDS = {"pause": "pause", "resume": "resume", "recall": "recall", "emergency-stop": "emergency_stop"}


@pytest.mark.parametrize("word", KINDS)
@pytest.mark.slow
async def test_a_command_reaches_the_robot_and_its_answer_is_seen(campus: Campus, word: str) -> None:
    await campus.connect()
    desk = await campus.browser("desk", Role.DISPATCHER)
    reason = {} if word == "resume" else {"reason": "A parade."}
    told = await desk.post(f"/robots/r1/{word}", json=reason)
    assert (told.status_code, told.json()["kind"], told.json()["online"]) == (202, KINDS[word], True)
    heard = (await campus.robot.hear(KINDS[word])).body
    assert heard.command_id == told.json()["command_id"]  # type: ignore[attr-defined]
    answer = CommandAnswer(command_id=told.json()["command_id"], accepted=True, happened_at=campus.robot.clock.utc())
    await campus.robot.ends(await campus.robot.say(Event(happened=answer)))
    (seen,) = (await desk.get("/robots/r1/commands")).json()["items"]
    assert (seen["accepted"], seen["command_id"]) == (True, heard.command_id)  # type: ignore[attr-defined]
    row = await campus.service.row(RobotCommand)
    assert row.asked_by_id is not None


async def test_a_robot_that_is_away_hears_of_it_when_it_is_back(campus: Campus) -> None:
    campus.token = await campus.service.enrol("r1")
    desk = await campus.browser("desk", Role.DISPATCHER)
    told = await desk.post("/robots/r1/pause", json={"reason": "A parade."})
    assert (told.status_code, told.json()["online"]) == (202, False)
    await campus.connect()
    await campus.robot.hear("pause")
    assert (await desk.post("/robots/r9/pause", json={"reason": "x"})).json()["code"] == "unknown_robot"


async def test_an_alarm_is_listed_acknowledged_and_over(campus: Campus) -> None:
    await campus.connect()
    desk = await campus.browser("desk", Role.DISPATCHER)
    fault = Fault(name="blocked", happened_at=campus.robot.clock.utc(), post="post2", reason="A box in the way.")
    await campus.robot.ends(await campus.robot.say(Event(happened=fault)))
    details = (await desk.get("/robots/r1")).json()
    assert {"blocked"} <= {one["name"] for one in details["alarms"]}
    assert (details["software"], details["takes_taps"], details["signs_receipts"]) == ("0.1.0", True, False)
    (alarm,) = [one for one in details["alarms"] if one["name"] == "blocked"]
    seen_to = await desk.post(f"/alarms/{alarm['id']}/acknowledge")
    assert seen_to.json()["acknowledged_at"]
    over = fault.model_copy(update={"cleared": True})
    await campus.robot.ends(await campus.robot.say(Event(happened=over)))
    listed = {one["name"]: one for one in (await desk.get("/alarms")).json()["items"]}
    assert listed["blocked"]["cleared_at"] and listed["blocked"]["acknowledged_at"]
    assert "blocked" not in {one["name"] for one in (await desk.get("/alarms?only_open=true")).json()["items"]}
    assert (await desk.post("/alarms/999/acknowledge")).json()["code"] == "unknown_alarm"


async def test_times_of_a_robot_whose_clock_is_off_are_put_right_and_it_is_told(
    campus: Campus, clock: SteppedClock
) -> None:
    """Ahead by an hour: people read when it happened, a dispatcher reads how far it is off."""
    campus.robot.clock = SteppedClock(started_at=clock.started_at + timedelta(hours=1))
    await campus.connect()
    mission = await campus.robot.mission()
    await campus.robot.ends(await campus.robot.report(mission, Step.ARRIVED, mission.stops[0]))
    sender, desk = await campus.browser("sender"), await campus.browser("desk", Role.DISPATCHER)
    (arrived,) = [one for one in (await sender.get(campus.path)).json()["events"] if one["state"] == "at_sender"]
    assert arrived["robot_at"] == arrived["at"]
    details = (await desk.get("/robots/r1")).json()
    assert details["clock_off_s"] == 3600
    assert "clock_off" in {one["name"] for one in details["alarms"]}


async def test_a_tap_is_good_by_the_robots_own_clock_however_far_that_is_ahead(
    campus: Campus, clock: SteppedClock
) -> None:
    ahead = SteppedClock(started_at=clock.started_at + timedelta(hours=1))
    campus.robot.clock = ahead
    await campus.waits_for_load()
    asked = await (await campus.browser("sender")).post(f"{campus.path}/handover", json={})
    wish = (await campus.robot.hear("confirm")).body
    assert isinstance(wish, Confirm)
    assert datetime.fromisoformat(asked.json()["expires_at"]) - clock.utc() == timedelta(seconds=60)
    assert wish.expires_at - ahead.utc() == timedelta(seconds=60), "the robot would have refused it as too late"


async def test_a_clock_that_is_set_while_the_robot_is_connected_is_noticed_at_its_next_word(
    campus: Campus, clock: SteppedClock
) -> None:
    """It started without network with the time of yesterday, and was set when it had found one."""
    campus.robot.clock = SteppedClock(started_at=clock.started_at - timedelta(days=1))
    await campus.connect()
    desk = await campus.browser("desk", Role.DISPATCHER)
    assert (await desk.get("/robots/r1")).json()["clock_off_s"] == -86400
    campus.robot.clock = clock
    mission = await campus.robot.mission()
    await campus.robot.ends(await campus.robot.report(mission, Step.ARRIVED, mission.stops[0]))
    details = (await desk.get("/robots/r1")).json()
    assert details["clock_off_s"] == 0
    assert "clock_off" not in {one["name"] for one in details["alarms"]}
    events = (await (await campus.browser("sender")).get(campus.path)).json()["events"]
    (arrived,) = [one for one in events if one["state"] == "at_sender"]
    assert arrived["robot_at"] == arrived["at"]


@pytest.mark.parametrize(
    ("known_s", "seen_s", "is_set"),
    [
        (0, -20, False),  # on its way for a while
        (0, -299, False),
        (0, -301, True),
        (0, 29, False),
        (0, 31, True),  # nothing comes before it was sent
        (-3600, 0, True),
        (3600, 3590, False),
    ],
)
def test_a_message_that_was_long_on_its_way_sets_no_clock(known_s: float, seen_s: float, is_set: bool) -> None:
    assert has_been_set(known_s, seen_s) is is_set
