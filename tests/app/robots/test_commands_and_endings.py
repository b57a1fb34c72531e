"""Orders that do not go as ordered: cancelled, not fetched, not taken; and a stolen token."""

import socket
from collections import Counter
from dataclasses import dataclass

import pytest
from websockets.asyncio.client import connect

from app.models import Alarm, Handover, MessageToRobot, Notification, Order
from app.robots.service import new_token
from protocol.clock import SteppedClock
from protocol.parts import Leg, Stop, StopAction
from protocol.to_robot import Cancel, Grant, Mission
from protocol.to_server import Claim, CommandAnswer, Event, Fault, Step
from tests.app.robots.playing import PlayedRobot, Service

LEG = Leg(from_post="post1", to_post="post2")


def accepts(command_id: str, robot: PlayedRobot) -> Event:
    return Event(happened=CommandAnswer(command_id=command_id, accepted=True, happened_at=robot.clock.utc()))


async def error_code(robot: PlayedRobot) -> str:
    return str((await robot.hear("error")).body.model_dump()["code"])


async def told_to_cancel(robot: PlayedRobot) -> Cancel:
    cancel = (await robot.hear("cancel")).body
    assert isinstance(cancel, Cancel)
    return cancel


async def test_a_robot_that_cannot_get_to_the_sender_is_free_and_the_order_says_why(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        await robot.report(mission, Step.DEPARTED, mission.stops[0])
        await robot.report(mission, Step.GAVE_UP, mission.stops[0], reason="no_route")
        await service.reaches(order_id, "attention")
        another = await service.order("post2", "post3")
        assert (await robot.mission()).stops[0].order_id == another
    assert "no_route" in (await service.row(Order, id=order_id)).why
    assert (await service.states(order_id))[-2:] == ["to_sender", "attention"]


async def test_mail_that_was_not_taken_is_brought_back_by_the_robots_own_mission(
    service: Service, robot: PlayedRobot
) -> None:
    order_id, receive = await carrying(service, robot)
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await robot.report(receive.mission, Step.ARRIVED, receive.stop)
        await robot.report(receive.mission, Step.GAVE_UP, receive.stop, reason="no_one_came")
        await robot.ends(await robot.report(receive.mission, Step.DONE))
        another = await service.order("post2", "post3")
        own, back = own_mission(order_id, "post1")
        await robot.report(own, Step.ACCEPTED)
        await robot.report(own, Step.DEPARTED, back)
        await robot.report(own, Step.ARRIVED, back)
        await service.reaches(order_id, "at_return")
        await service.app.state.parts.dispatcher.poll()
        assert await service.states(another) == ["queued"], "its mail comes first"
        await robot.say(robot.receipt(back))
        await robot.ends(await robot.report(own, Step.DONE))
        await service.reaches(order_id, "returned")
        assert (await robot.mission()).stops[0].post == "post2", "free again"
    assert (await service.states(order_id))[-4:] == ["at_recipient", "returning", "at_return", "returned"]


async def test_mail_that_is_not_taken_back_either_waits_for_a_person(service: Service, robot: PlayedRobot) -> None:
    order_id, receive = await carrying(service, robot)
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await robot.report(receive.mission, Step.GAVE_UP, receive.stop, reason="no_route")
        await robot.report(receive.mission, Step.DONE)
        own, back = own_mission(order_id, "post1")
        for step in (Step.ARRIVED, Step.GAVE_UP):
            await robot.report(own, step, back, reason="no_one_came")
        await robot.ends(await robot.report(own, Step.DONE))
        await service.reaches(order_id, "attention")
        another = await service.order("post2", "post3")
        await service.app.state.parts.dispatcher.poll()
        assert await service.states(another) == ["queued"], "the mail is still aboard"
    assert "still in robot r1" in (await service.row(Order, id=order_id)).why


@pytest.mark.parametrize("name", ["wheel_drop", "camera_lost"])
async def test_a_fault_with_mail_aboard_calls_a_person_and_ends_when_it_is_over_or_the_robot_goes_on(
    service: Service, robot: PlayedRobot, name: str
) -> None:
    order_id, receive = await carrying(service, robot)
    lifted = Fault(name=name, happened_at=robot.clock.utc(), post="post3", reason="The robot was lifted.")
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await robot.say(Event(happened=lifted))
        await robot.ends(await robot.say(Event(happened=lifted.model_copy(update={"cleared": True}))))
        assert (await service.states(order_id))[-2:] == ["attention", "carrying"]
        await robot.report(receive.mission, Step.ARRIVED, receive.stop)
        await robot.say(Event(happened=lifted))
        await robot.ends(await robot.report(receive.mission, Step.ARRIVED, receive.stop))
        order = await service.row(Order, id=order_id)
        assert (str(order.state), order.why) == ("attention", "The robot was lifted."), "it has said that before"
        await robot.ends(await robot.say(robot.receipt(receive.stop)))
    assert (await service.states(order_id))[-3:] == ["attention", "at_recipient", "delivered"]
    assert (await told(service, order_id))["robot_here_for_you"] == 1, "before it was lifted"
    assert (await told(service, order_id))["delivered"] == 2, "the sender and the recipient"


async def test_who_was_told_that_mail_was_not_taken_is_not_told_so_again_when_it_is_back(
    service: Service, robot: PlayedRobot
) -> None:
    order_id, receive = await carrying(service, robot)
    lifted = Fault(name="wheel_drop", happened_at=robot.clock.utc(), post="post3", reason="The robot was lifted.")
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await robot.report(receive.mission, Step.GAVE_UP, receive.stop, reason="no_one_came")
        await robot.report(receive.mission, Step.DONE)
        own, back = own_mission(order_id, "post1")
        await robot.report(own, Step.DEPARTED, back)
        await robot.say(Event(happened=lifted))
        await robot.ends(await robot.say(robot.receipt(back)))
    assert (await service.states(order_id))[-5:] == ["returning", "attention", "returning", "at_return", "returned"]
    counts = await told(service, order_id)
    assert (counts["not_taken"], counts["attention"], counts["returned"]) == (2, 2, 2), "once to each side"


async def told(service: Service, order_id: str) -> Counter[str]:
    return Counter(str(one.kind) for one in await service.rows(Notification, order_id=order_id))


async def test_mail_that_is_called_back_turns_round_when_the_robot_says_so(
    service: Service, robot: PlayedRobot
) -> None:
    order_id, receive = await carrying(service, robot)
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await service.cancel(order_id)
        update = await robot.mission()
        assert (update.id, update.update) == (receive.mission.id, 2)
        assert [(stop.action, stop.post) for stop in update.stops] == [("return", "post1")]
        assert (await service.states(order_id))[-1] == "carrying"
        await robot.ends(await robot.report(update, Step.ACCEPTED, update=1))
        assert (await service.states(order_id))[-1] == "carrying", "that was the mission before"
        await robot.ends(await robot.report(update, Step.ACCEPTED, update=2))
        assert (await service.states(order_id))[-1] == "returning"
        await robot.report(update, Step.ARRIVED, update.stops[0], update=2)
        await robot.ends(await robot.say(robot.receipt(update.stops[0])))
    assert (await service.states(order_id))[-2:] == ["at_return", "returned"]


async def test_mail_that_was_called_back_too_late_is_delivered_and_the_robot_free(
    service: Service, robot: PlayedRobot
) -> None:
    """It gave up, and before it heard that the mail was to come back, the recipient took it after all."""
    order_id, receive = await carrying(service, robot)
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await service.cancel(order_id)
        await robot.mission()
        await robot.report(receive.mission, Step.ARRIVED, receive.stop)
        await robot.report(receive.mission, Step.GAVE_UP, receive.stop, reason="no_one_came")
        await service.reaches(order_id, "returning")
        await robot.say(robot.receipt(receive.stop))
        await service.reaches(order_id, "delivered")
        another = await service.order("post2", "post3")
        assert (await robot.mission()).stops[0].order_id == another


async def test_what_an_update_brings_is_not_over_with_a_mission_that_did_not_know_of_it(
    service: Service, robot: PlayedRobot
) -> None:
    order_id, receive = await carrying(service, robot)
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        await service.cancel(order_id)
        update = await robot.mission()
        await robot.report(receive.mission, Step.GAVE_UP, receive.stop, reason="no_one_came")
        await robot.ends(await robot.report(receive.mission, Step.DONE, update=1))
        assert (await service.states(order_id))[-1] == "returning", "no person has to look for it"
        await robot.report(update, Step.ACCEPTED, update=2)
        await robot.say(robot.receipt(update.stops[0]))
        await service.reaches(order_id, "returned")


@dataclass
class Ahead:
    mission: Mission
    stop: Stop


async def carrying(service: Service, robot: PlayedRobot) -> tuple[str, Ahead]:
    """An order whose mail is aboard, and what its robot has still to do."""
    robot.token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, robot.token):
        await robot.greet()
        mission = await robot.mission()
        load, receive = mission.stops
        await robot.report(mission, Step.ACCEPTED, update=1)
        await robot.ends(await robot.say(robot.receipt(load)))
    return order_id, Ahead(mission, receive)


def own_mission(order_id: str, post: str) -> tuple[Mission, Stop]:
    """A mission that a robot gives to itself (decision 0017)."""
    stop = Stop(id=f"return-{order_id}", post=post, action=StopAction.RETURN, order_id=order_id)
    return Mission(id="return-0123456789abcdef", update=1, stops=(stop,)), stop


async def test_a_robot_drops_only_what_it_was_told_to_drop(service: Service, robot: PlayedRobot) -> None:
    other = PlayedRobot(robot.clock, name="r2", journal="journal-r2")
    tokens = [await service.enrol(name) for name in ("r1", "r2")]
    order_id = await service.order()
    async with robot.connected(service.url, tokens[0]):
        await robot.greet()
        await robot.mission()
        await robot.say(accepts(f"cancel-{order_id}", robot))
        assert await error_code(robot) == "unknown_command"
        await service.cancel(order_id)
        async with other.connected(service.url, tokens[1]):
            await other.greet()
            await other.say(accepts(f"cancel-{order_id}", other))
            assert await error_code(other) == "unknown_command"
    assert await service.states(order_id) == ["queued", "assigned"]


async def test_a_robot_tells_nothing_of_what_another_was_given(service: Service, robot: PlayedRobot) -> None:
    other = PlayedRobot(robot.clock, name="r2", journal="journal-r2")
    tokens = [await service.enrol(name) for name in ("r1", "r2")]
    order_id = await service.order()
    async with robot.connected(service.url, tokens[0]), other.connected(service.url, tokens[1]):
        await robot.greet()
        mission = await robot.mission()
        load = mission.stops[0]
        await other.greet(post=None)
        for tale in (other.progress(mission, Step.ARRIVED, load), other.receipt(load)):
            await other.say(tale)
            assert await error_code(other) in {"unknown_mission", "unknown_stop"}
    assert await service.states(order_id) == ["queued", "assigned"]
    assert await service.rows(Handover) == []


@pytest.mark.parametrize(("step", "reason"), [(Step.ARRIVED, "no_one_came"), (Step.DEPARTED, "no_route")])
async def test_a_robot_that_gives_up_what_was_to_be_cancelled_has_cancelled_it(
    service: Service, robot: PlayedRobot, step: Step, reason: str
) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        await robot.ends(await robot.report(mission, step, mission.stops[0]))
        await service.cancel(order_id)
        await robot.report(mission, Step.GAVE_UP, mission.stops[0], reason=reason)
        cancel = await told_to_cancel(robot)
        await robot.ends(await robot.say(accepts(cancel.command_id, robot)))
    assert (await service.states(order_id))[-1] == "cancelled"
    assert await service.rows(Alarm, name="transition_refused") == []


async def test_a_robot_without_its_memory_is_told_again_what_to_drop(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        await service.cancel(order_id)
        await robot.hear("cancel")
        await robot.ends(await robot.report(mission, Step.ACCEPTED))  # with it, the cancel is acknowledged
    new_disk = PlayedRobot(clock, journal="journal-2")
    async with new_disk.connected(service.url, token):
        await new_disk.greet()
        assert (await new_disk.mission()).update == 2
        assert (await told_to_cancel(new_disk)).order_id == order_id


async def test_a_receipt_for_the_wrong_end_of_an_order_is_refused(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        load, receive = (await robot.mission()).stops
        await robot.say(robot.receipt(load))
        await robot.say(robot.receipt(load.model_copy(update={"action": receive.action})))
        assert await error_code(robot) == "unknown_stop"
    assert (await service.states(order_id))[-1] == "carrying"


async def test_a_token_that_is_revoked_closes_the_connection_it_had_opened(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet()
        async with service.app.state.parts.database.transaction() as session:
            await new_token(session, service.app.state.parts.clock, "r1")
        await service.order()
        assert await robot.close_code() == 4401
    assert "mission" not in [envelope.type for envelope in robot.heard], "it hears nothing more"


async def test_a_token_is_taken_over_wss_alone_but_from_this_machine(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    url = service.url.replace("127.0.0.1", "mail.campus.example")
    sock = socket.create_connection(("127.0.0.1", service.port))
    headers = {"Authorization": f"Bearer {token}"}
    async with connect(url, sock=sock, additional_headers=headers, proxy=None) as robot.socket:
        assert await robot.close_code() == 4401


async def test_a_robot_without_its_memory_gets_what_is_left_of_its_mission(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        await robot.report(mission, Step.ARRIVED, mission.stops[0])
        await robot.ends(await robot.say(robot.receipt(mission.stops[0])))
        await robot.say(Claim(claim_id="c1", legs=(LEG,)))
        await robot.hear("grant")
    new_disk = PlayedRobot(clock, journal="journal-2")
    async with new_disk.connected(service.url, token):
        await new_disk.greet()
        again = await new_disk.mission()
        if again.update == 1:  # what the old disk had not acknowledged comes first
            again = await new_disk.mission()
    assert (again.id, again.update, again.stops) == (mission.id, 2, mission.stops[1:])
    grants = [one.body for one in new_disk.heard if isinstance(one.body, Grant)]
    assert grants[-1].legs == (LEG,), "it may stand there"
    assert len(await service.rows(Alarm, name="memory_lost")) == 1
    assert str((await service.row(Order, id=order_id)).state) == "carrying"


async def test_a_cancelled_order_is_taken_from_the_robot_which_is_free_again(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.mission()
        await service.cancel(order_id)
        cancel = await told_to_cancel(robot)
        assert cancel.order_id == order_id
        await robot.say(accepts(cancel.command_id, robot))
        await service.reaches(order_id, "cancelled")
        another = await service.order("post2", "post3")
        assert (await robot.mission()).stops[0].order_id == another
    assert len(await service.rows(MessageToRobot, type="cancel")) == 1


async def test_a_sender_who_never_came_frees_the_robot(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        await robot.report(mission, Step.ARRIVED, mission.stops[0])
        await robot.report(mission, Step.GAVE_UP, mission.stops[0], reason="nobody came in 600 s")
        await service.reaches(order_id, "expired")
        another = await service.order()
        assert (await robot.mission()).stops[0].order_id == another
