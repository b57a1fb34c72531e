"""A dispatcher who has looked tells a robot that a corridor is open again; its own word ends the alarm."""

from app.models import Role
from protocol.envelope import YOUNGER
from protocol.parts import Leg
from protocol.to_robot import OpenWay
from protocol.to_server import CommandAnswer, Event, Fault
from robot.agent.actions.corridors import WAY_BLOCKED, tried_again, turned_back
from tests.app.handover.conftest import Campus

TO_POST2, TO_POST1 = Leg(from_post="post3", to_post="post2"), Leg(from_post="post2", to_post="post1")
PATH = "/robots/r1/open-way"


async def found_closed(campus: Campus, *legs: Leg) -> None:
    for leg in legs:
        await says(campus, turned_back(leg, "blocked"))


async def says(campus: Campus, reason: str, cleared: bool = False) -> None:
    fault = Fault(name=WAY_BLOCKED, happened_at=campus.robot.clock.utc(), reason=reason, cleared=cleared)
    await campus.robot.ends(await campus.robot.say(Event(happened=fault)))


async def test_a_dispatcher_who_has_looked_tells_the_robot_whose_word_ends_the_alarm(campus: Campus) -> None:
    await campus.connect(understands=YOUNGER)
    desk = await campus.browser("desk", Role.DISPATCHER)
    await found_closed(campus, TO_POST2, TO_POST1)
    told = await desk.post(PATH, json={"corridor": "post2-post3"})
    assert (told.status_code, told.json()["kind"], told.json()["accepted"]) == (202, "open_way", None)
    wish = (await campus.robot.hear("open_way")).body
    assert isinstance(wish, OpenWay)
    assert (set(wish.ends), wish.looked_at) == ({"post2", "post3"}, campus.robot.clock.utc())

    async def closed() -> set[str]:
        return {
            one["corridor"] for one in (await desk.get("/alarms?only_open=true")).json()["items"] if one["corridor"]
        }

    assert await closed() == {"post2-post3", "post1-post2"}, "until the robot has said so"
    answer = CommandAnswer(command_id=wish.command_id, accepted=True, happened_at=campus.robot.clock.utc())
    await campus.robot.ends(await campus.robot.say(Event(happened=answer)))
    await says(campus, tried_again("post2-post3"), cleared=True)
    assert await closed() == {"post1-post2"}, "no person has looked there"
    (seen,) = (await desk.get("/robots/r1/commands")).json()["items"]
    assert (seen["kind"], seen["accepted"]) == ("open_way", True)
    await says(campus, "The robot tries that way again.", cleared=True)
    assert await closed() == set(), "an older robot says it of all at once"


async def test_a_robot_that_could_not_do_so_is_not_told(campus: Campus) -> None:
    campus.token = await campus.service.enrol("r1")
    desk = await campus.browser("desk", Role.DISPATCHER)
    way = {"corridor": "post2-post3"}
    away = await desk.post(PATH, json=way)
    assert (away.status_code, away.json()["code"]) == (409, "robot_away")
    await campus.connect(understands=("confirm", "watch"))
    old = await desk.post(PATH, json=way)
    assert (old.status_code, old.json()["code"]) == (409, "robot_too_old")
    nowhere = await desk.post(PATH, json={"corridor": "post3-post2"})
    assert (nowhere.status_code, nowhere.json()["code"]) == (422, "no_such_corridor")
    assert (await desk.post("/robots/r9/open-way", json=way)).json()["code"] == "unknown_robot"
    assert (await desk.get("/robots/r1/commands")).json()["items"] == []


async def test_a_robot_that_knows_better_is_heard(campus: Campus) -> None:
    await campus.connect(understands=YOUNGER)
    desk = await campus.browser("desk", Role.DISPATCHER)
    asked = (await desk.post(PATH, json={"corridor": "post2-post3"})).json()
    reason = "The robot has turned back between post2 and post3 again since."
    answer = CommandAnswer(
        command_id=asked["command_id"], accepted=False, happened_at=campus.robot.clock.utc(), reason=reason
    )
    await campus.robot.ends(await campus.robot.say(Event(happened=answer)))
    (alarm,) = [one for one in (await desk.get("/alarms")).json()["items"] if one["name"] == "command_refused"]
    assert (alarm["reason"], alarm["why_words"]["facts"]) == (reason, {"from": "post2", "to": "post3"})
