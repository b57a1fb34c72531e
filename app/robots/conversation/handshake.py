"""The beginning of a connection: both sides learn where the other stands, and nothing is lost or done twice."""

from dataclasses import dataclass
from datetime import datetime
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import RobotRow
from app.orders.stops import active_mission
from app.robots.alarms import clear_alarms, raise_alarm
from app.robots.commands import REVOKE, ask, new_command_id, unanswered
from app.robots.corridors import reservations
from app.robots.homes import note_home
from app.robots.link import clocks, inbox, outbox
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet, note_state
from protocol.envelope import Envelope
from protocol.parts import Received
from protocol.to_robot import Cancel, EmergencyStop, Grant, Revoke, Welcome
from protocol.to_server import Hello

PROOF: Final = "proof"


@dataclass(frozen=True)
class Greeted:
    """Where both sides stand when the conversation begins."""

    welcome: Welcome
    server_journal: str
    received_seq: int
    acknowledged_seq: int


async def greet(session: AsyncSession, fleet: Fleet, robot: RobotRow, envelope: Envelope, hello: Hello) -> Greeted:
    """Note what the robot says of itself, settle both journals, and give it its mission again if it has lost it."""
    now = fleet.clock.utc()
    is_new_memory = await inbox.knows_another_journal(session, robot.name, envelope.journal)
    received_seq, lost = await inbox.resume(session, robot.name, envelope.journal, hello.resume_from, now)
    if lost:
        await raise_alarm(session, robot.name, "messages_lost", f"{lost} messages of this robot are lost", now=now)
    await _settle_outbox(session, robot, hello.received, now)
    if is_new_memory:
        await restate(session, fleet, robot)
    await clocks.compare(session, robot, envelope.at, now)
    await _compare_maps(session, fleet, robot, hello, now)
    note_state(robot, fleet.campus, hello.position, hello.battery)
    robot.software, robot.map_version, robot.online, robot.heard_at = hello.software, hello.map_version, True, now
    robot.takes_confirm = "confirm" in hello.understands
    home = await note_home(session, fleet.campus, robot, hello)
    if PROOF in hello.understands:
        robot.proves_since = robot.proves_since or now
    await _tell_out_of_service(session, fleet, robot, understands=REVOKE in hello.understands)
    await fleet.batteries.note(session, [robot], now)
    fleet.announce(session, robot)
    resume_from = await outbox.resume_from(session, robot)
    welcome = Welcome(
        received=Received(journal=envelope.journal, seq=received_seq),
        resume_from=resume_from,
        server=f"Campus Mail, {fleet.campus.title}",
        at=now,
        home=home,
    )
    return Greeted(welcome, robot.server_journal, received_seq, resume_from - 1)


async def _settle_outbox(session: AsyncSession, robot: RobotRow, received: Received, now: datetime) -> None:
    if outbox.went_back_in_time(robot, received):
        outbox.renew_journal(robot)
        sentence = "the robot knows later messages of this service than the service does: was the database put back?"
        await raise_alarm(session, robot.name, "service_went_back", sentence, now=now)
    elif received.journal == robot.server_journal:
        await outbox.acknowledged(session, robot.name, received.seq, now)


async def restate(session: AsyncSession, fleet: Fleet, robot: RobotRow) -> None:
    """The robot's memory is new: the corridors it holds, and what is left of its mission under the next number."""
    if held := await reservations.held_by(session, robot.name):
        # It may stand in one of them: it has to know that it may leave, and has to report it clear.
        await fleet.tell(session, robot, Grant(claim_id=f"restated-{robot.last_seq + 1}", legs=held))
    mission = await active_mission(session, robot.name)
    if mission is None:
        return
    now = fleet.clock.utc()
    await raise_alarm(
        session, robot.name, "memory_lost", "the robot came back without its memory in a mission", now=now
    )
    mission.update_number += 1
    await tell_mission(session, fleet, robot, mission, anew=True)
    for command in await unanswered(session, robot=robot.name, kind="cancel"):
        # It was told before, but who knows whether it had got round to it.
        await fleet.tell(session, robot, Cancel(command_id=command.command_id, order_id=command.order_id or ""))


async def _compare_maps(session: AsyncSession, fleet: Fleet, robot: RobotRow, hello: Hello, now: datetime) -> None:
    if hello.map_version != fleet.campus.version:
        sentence = f"the robot has map {hello.map_version}, the service {fleet.campus.version}: give it the same file"
        await raise_alarm(session, robot.name, "other_map", sentence, now=now)
    else:
        await clear_alarms(session, robot.name, "other_map", now)


async def _tell_out_of_service(session: AsyncSession, fleet: Fleet, robot: RobotRow, understands: bool) -> None:
    """It is back: what it was granted when it was last heard is not its any more. One that is too old to understand
    that is stopped each time, and stays out."""
    if robot.taken_out_at is None:
        return
    if not understands:
        stop = EmergencyStop(command_id=new_command_id("stop"), reason="Its corridors were given to others.")
        await ask(session, fleet, robot, stop)
        return
    for command in await unanswered(session, robot=robot.name, kind=REVOKE):
        wish = Revoke(command_id=command.command_id, reason=command.asked_because or "")
        await fleet.tell(session, robot, wish)
