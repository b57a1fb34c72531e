"""The service's end of the link: who may connect, what is refused by name, and that nothing is lost or done twice."""

import json

import pytest
from sqlmodel import select
from structlog.testing import capture_logs

from app.core.database.database import Database
from app.core.settings import Settings
from app.models import Alarm, GrantRow, Handover, MessageToRobot, MissionRow, RobotMessage, RobotRow, RobotToken
from app.robots.conversation.conversation import MAX_UNACKNOWLEDGED
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery, Leg, Position, Received
from protocol.to_robot import Grant, Resume, Verifiers
from protocol.to_server import Claim, Clear, Event, Fault, Snapshot, Step, Why
from tests.app.robots.playing import PlayedRobot, Service, serving, until

LEG = Leg(from_post="post1", to_post="post2")


async def test_an_order_goes_through_its_life_on_a_robots_word(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    order_id = await service.order("post1", "post4")
    async with robot.connected(service.url, token):
        await robot.greet()
        verifiers = (await robot.hear("verifiers")).body
        mission = await robot.mission()
        load, receive = mission.stops
        assert isinstance(verifiers, Verifiers)
        assert {(one.order_id, one.purpose) for one in verifiers.verifiers} == {
            (order_id, "load"),
            (order_id, "receive"),
            (order_id, "return"),
        }
        assert [(stop.post, stop.action, stop.order_id) for stop in mission.stops] == [
            ("post1", "load", order_id),
            ("post4", "receive", order_id),
        ]
        await robot.report(mission, Step.ACCEPTED)
        await robot.report(mission, Step.DEPARTED, load)
        await robot.report(mission, Step.ARRIVED, load)
        await robot.say(robot.receipt(load))
        await robot.report(mission, Step.DEPARTED, receive)
        await robot.report(mission, Step.ARRIVED, receive)
        await robot.say(robot.receipt(receive))
        await robot.ends(await robot.report(mission, Step.DONE))
    states = ["queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered"]
    assert await service.states(order_id) == states
    assert [row.purpose for row in await service.rows(Handover)] == ["load", "receive"]
    assert (await service.row(MissionRow)).state == "done"
    assert await service.rows(Alarm, name="unknown_mission") == []


async def test_a_wrong_token_is_refused_and_only_the_hash_of_the_right_one_is_kept(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    prefix = token.split("_")[1]
    row = await service.row(RobotToken)
    assert row.prefix == prefix
    assert token.split("_", 2)[2] not in repr(row)
    for wrong in ("", "nonsense", f"cmr_{prefix}_{'x' * 43}", f"cmr_00000000_{token.split('_', 2)[2]}"):
        async with robot.connected(service.url, wrong):
            assert await robot.close_code() == 4401


async def test_a_second_socket_takes_the_first_ones_place_and_rings_an_alarm(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    copied = PlayedRobot(clock, journal="journal-of-a-thief")
    async with robot.connected(service.url, token):
        await robot.greet()
        assert (await service.row(RobotToken)).used_at == clock.utc()
        async with copied.connected(service.url, token):
            await copied.greet()
            assert await robot.close_code() == 4409
            assert (await service.row(RobotRow)).online
            assert len(await service.rows(Alarm, name="second_socket")) == 1
    await until(lambda: _is_offline(service))


async def _is_offline(service: Service) -> bool:
    return not (await service.row(RobotRow)).online


async def test_the_same_robot_that_comes_back_before_its_loss_was_noticed_rings_no_alarm(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    again = PlayedRobot(clock)
    async with robot.connected(service.url, token), again.connected(service.url, token):
        await robot.greet()
        await again.greet()
        assert await robot.close_code() == 4409
        assert await service.rows(Alarm, name="second_socket") == []


ENVELOPE = {"v": 1, "type": "why", "robot": "r1", "journal": "journal-1", "at": "2026-01-05T09:00:00Z", "body": {}}


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("no json", "malformed_message"),
        (json.dumps({**ENVELOPE, "body": {"sentense": "x"}}), "malformed_message"),
        (json.dumps({**ENVELOPE, "type": "dance"}), "unknown_message"),
        (json.dumps({**ENVELOPE, "v": 2}), "newer_version"),
        (json.dumps({**ENVELOPE, "body": {"sentence": "x" * 70_000}}), "message_too_large"),
        (json.dumps({**ENVELOPE, "robot": "r2", "body": {"sentence": "x"}}), "wrong_robot"),
        (json.dumps({**ENVELOPE, "journal": "another", "body": {"sentence": "x"}}), "out_of_turn"),
    ],
)
async def test_what_cannot_be_taken_is_answered_by_name_and_the_connection_closed(
    service: Service, robot: PlayedRobot, text: str, code: str
) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.say_text(text)
        error = (await robot.hear("error")).body
        assert error.model_dump()["code"] == code
        assert await robot.close_code() == 4400
    async with robot.connected(service.url, token):
        await robot.greet()  # nothing is broken for good


async def test_a_connection_begins_with_hello(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.say(Clear(leg=LEG))
        error = (await robot.hear("error")).body.model_dump()
        assert (error["code"], error["seq"]) == ("out_of_turn", 1)
        assert await robot.close_code() == 4400
    assert await service.rows(RobotMessage) == []


async def test_after_a_cut_the_robot_resumes_and_nothing_is_done_twice(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        departed = robot.progress(mission, Step.DEPARTED, mission.stops[0])
        arrived = robot.progress(mission, Step.ARRIVED, mission.stops[0])
        await robot.say(departed)
        await robot.say(arrived)
        await service.reaches(order_id, "at_sender")  # committed; the robot never hears of it
        assert robot.socket is not None
        robot.socket.transport.abort()
    async with robot.connected(service.url, token):
        welcome = await robot.greet(resume_from=1)
        assert welcome.received == Received(journal="journal-1", seq=2)
        await robot.say(departed, seq=1, replay=True)
        await robot.say(arrived, seq=2, replay=True)
        assert (await robot.hear("ack")).ack == 2
        await robot.ends(await robot.say(robot.receipt(mission.stops[0])))
    assert await service.states(order_id) == ["queued", "assigned", "to_sender", "at_sender", "carrying"]
    assert [row.seq for row in await service.rows(RobotMessage)] == [1, 2, 3]


async def test_a_gap_is_refused_and_what_came_before_it_is_kept(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.ends(await robot.say(Clear(leg=LEG)))
        await robot.say(Clear(leg=LEG), seq=3)
        error = (await robot.hear("error")).body.model_dump()
        assert (error["code"], error["seq"]) == ("message_gap", 3)
        assert await robot.close_code() == 4400
    assert [row.seq for row in await service.rows(RobotMessage)] == [1]


async def test_messages_that_can_never_come_are_skipped_and_ring_an_alarm(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.ends(await robot.say(Clear(leg=LEG)))
    async with robot.connected(service.url, token):
        assert (await robot.greet(resume_from=5)).received.seq == 4
        await robot.say(Clear(leg=LEG), seq=5)
        await robot.ends(5)
    assert (await service.row(Alarm, name="messages_lost")).reason == "3 messages of this robot are lost"


async def test_nothing_is_acknowledged_before_it_is_committed(
    service: Service, robot: PlayedRobot, settings: Settings
) -> None:
    """Another process holds the database's write lock: as long as nothing can be committed, nothing is acknowledged."""
    token = await service.enrol("r1")
    other = Database(settings.url_of_database)
    async with robot.connected(service.url, token):
        await robot.greet()
        async with other.transaction() as lock:
            await lock.exec(select(RobotRow))  # the lock is taken with the first question
            seq = await robot.say(Clear(leg=LEG))
            with pytest.raises(TimeoutError):
                await robot.hear("ack", limit_s=0.5)
            assert await service.rows(RobotMessage) == []
        await robot.ends(seq)
    await other.close()
    assert [row.seq for row in await service.rows(RobotMessage)] == [1]


async def test_the_service_restarts_and_both_sides_go_on_where_they_were(
    settings: Settings, clock: SteppedClock, robot: PlayedRobot
) -> None:
    async with serving(settings, clock) as service:
        token = await service.enrol("r1")
        order_id = await service.order()
        async with robot.connected(service.url, token):
            await robot.greet()
            await robot.hear("verifiers")  # stored; the mission never arrives
            robot.received = robot.received.model_copy(update={"seq": 1})
    async with serving(settings, clock) as service:
        assert not (await service.row(RobotRow)).online
        async with robot.connected(service.url, token):
            welcome = await robot.greet()
            assert welcome.resume_from == 2
            mission = await robot.mission()
            assert robot.heard[-1].seq == 2
            await robot.ends(await robot.report(mission, Step.DEPARTED, mission.stops[0]))
        assert await service.states(order_id) == ["queued", "assigned", "to_sender"]


async def test_what_was_not_acknowledged_is_sent_again_and_what_was_is_not(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.mission()
    robot.received = Received()  # it had not stored any of it
    async with robot.connected(service.url, token):
        assert (await robot.greet()).resume_from == 1
        await robot.mission()
        await robot.say(Why(sentence="waits"))  # its `ack` tells that both are stored

        async def all_acknowledged() -> bool:
            return all(row.acked_at for row in await service.rows(MessageToRobot))

        await until(all_acknowledged)
    async with robot.connected(service.url, token):
        assert (await robot.greet()).resume_from == 3
        with pytest.raises(TimeoutError):
            await robot.hear("mission", limit_s=0.2)


async def test_a_service_whose_database_was_put_back_begins_a_new_journal(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    journal = (await service.row(RobotRow)).server_journal
    robot.received = Received(journal=journal, seq=12)
    async with robot.connected(service.url, token):
        await robot.greet()
        assert robot.heard[-1].journal != journal
        assert (await service.row(RobotRow)).server_journal == robot.heard[-1].journal
    assert len(await service.rows(Alarm, name="service_went_back")) == 1


async def test_what_cannot_be_followed_is_written_down_answered_and_does_not_come_again_for_ever(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        stranger = mission.model_copy(update={"id": "m-unknown"})
        await robot.report(stranger, Step.ACCEPTED)
        await robot.say(robot.receipt(mission.stops[1]))  # received before it was loaded
        await robot.say(Clear(leg=Leg(from_post="post1", to_post="post4")))
        codes = [(await robot.hear("error")).body.model_dump()["code"] for _ in range(3)]
        assert codes == ["unknown_mission", "transition_refused", "unknown_corridor"]
        await robot.ends(await robot.report(mission, Step.DEPARTED, mission.stops[0]))
    assert await service.states(order_id) == ["queued", "assigned", "to_sender"]
    assert await service.rows(Handover) == [], "nothing of a refused receipt is left"
    assert {row.name for row in await service.rows(Alarm)} >= set(codes)


async def test_a_service_that_fails_says_so_and_the_robot_keeps_what_it_had_to_say(
    service: Service, robot: PlayedRobot
) -> None:
    """The table is away for a while, as after a mistake of a person."""
    token = await service.enrol("r1")
    engine = service.app.state.parts.database.writing
    async with engine.begin() as connection:
        await connection.exec_driver_sql("ALTER TABLE robot_messages RENAME TO away")
    with capture_logs() as logs:
        async with robot.connected(service.url, token):
            await robot.greet()
            await robot.say(Clear(leg=LEG))
            assert await robot.close_code() == 1011
    assert [line["log_level"] for line in logs if line["event"] == "conversation_failed"] == ["error"]
    async with engine.begin() as connection:
        await connection.exec_driver_sql("ALTER TABLE away RENAME TO robot_messages")
    async with robot.connected(service.url, token):
        assert (await robot.greet()).received.seq == 0
        await robot.say(Clear(leg=LEG), seq=1)
        await robot.ends(1)


async def test_a_slow_robot_gets_no_more_than_it_acknowledges(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    many = MAX_UNACKNOWLEDGED + 10
    async with service.app.state.parts.database.transaction() as session:
        row = await session.get(RobotRow, "r1")
        for number in range(many):
            await service.app.state.parts.fleet.tell(session, row, Resume(command_id=f"c{number}"))
    async with robot.connected(service.url, token):
        await robot.greet()
        with pytest.raises(TimeoutError):
            await robot.hear("nothing of the kind", limit_s=0.5)
        assert robot.received.seq == MAX_UNACKNOWLEDGED
        await robot.say(Why(sentence="acknowledges by the way"))
        while robot.received.seq < many:
            await robot.hear("resume")
    assert [one.seq for one in robot.heard if one.seq] == list(range(1, many + 1))


async def test_claims_are_granted_once_and_cleared_by_the_robot_alone(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    legs = (LEG, Leg(from_post="post2", to_post="post3"))
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.say(Claim(claim_id="c1", legs=legs))
        assert (await robot.hear("grant")).body == Grant(claim_id="c1", legs=legs)
        await robot.say(Claim(claim_id="c2", legs=(Leg(from_post="post1", to_post="post4"),)))
        deny = (await robot.hear("deny")).body.model_dump()
        assert (deny["claim_id"], "no corridor post1-post4" in deny["reason"]) == ("c2", True)
        await robot.ends(await robot.say(Clear(leg=LEG)))
    rows = sorted(await service.rows(GrantRow), key=lambda row: row.corridor)
    assert [(row.corridor, row.cleared_at is None) for row in rows] == [("post1-post2", False), ("post2-post3", True)]


async def test_the_page_sees_what_snapshots_and_reasons_say(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    position = Position(post="post2", previous="post1", towards="post3", seen_at=robot.clock.utc())
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.say(Snapshot(position=position, activity=Activity.DRIVING, battery=Battery(ratio=0.5)))
        await robot.say(Why(sentence="Drives to post4 with mail", waiting_for=None))

        async def view() -> dict[str, object] | None:
            async with service.app.state.parts.database.reading() as session:
                (one,) = await service.app.state.parts.fleet.views(session)
            return one.model_dump(mode="json") if one.why else None

        seen = await until(view)
    assert seen["last_seen"]["post"] == "post2"
    assert (seen["towards"], seen["activity"], seen["battery"]["ratio"]) == ("post3", "driving", 0.5)
    assert (seen["why"], seen["online"], seen["expected"]["post"]) == ("Drives to post4 with mail", True, "post3")


async def test_a_fault_is_an_alarm_until_it_is_over(service: Service, robot: PlayedRobot) -> None:
    token = await service.enrol("r1")
    fault = Fault(name="cliff", happened_at=robot.clock.utc(), post="post2", reason="front left")
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.say(Event(happened=fault))
        await robot.ends(await robot.say(Event(happened=fault)))
        assert (await service.row(Alarm, name="cliff")).cleared_at is None
        await robot.ends(await robot.say(Event(happened=fault.model_copy(update={"cleared": True}))))
    assert (await service.row(Alarm, name="cliff")).cleared_at is not None


async def test_a_robot_that_falls_silent_is_shown_as_offline(
    settings: Settings, clock: SteppedClock, robot: PlayedRobot
) -> None:
    """Its machine is still there and answers no ping: as when it has driven out of the network's reach."""
    async with serving(settings, clock, ping_s=0.5) as service:
        token = await service.enrol("r1")
        async with robot.connected(service.url, token):
            await robot.greet()
            assert robot.socket is not None
            robot.socket.transport.pause_reading()
            await until(lambda: _is_offline(service))
            robot.socket.transport.abort()


async def test_a_clock_far_off_and_another_map_are_reported(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    slow = SteppedClock(now_s=-3600.0)
    late = PlayedRobot(slow)
    async with late.connected(service.url, token):
        await late.greet()
    assert (await service.row(Alarm, name="clock_off")).reason.endswith("-3600 s")
    assert "give it the same file" in (await service.row(Alarm, name="other_map")).reason
    async with PlayedRobot(clock).connected(service.url, token) as right:
        await right.greet(map_version=service.app.state.parts.campus.version)
    assert all(row.cleared_at for row in await service.rows(Alarm)), "both are over"
