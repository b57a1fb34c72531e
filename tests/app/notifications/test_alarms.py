"""Dispatchers are notified of an alarm once, in the inbox and on their channels; an acknowledged alarm is silent."""

from sqlmodel import col, select

from app.core.settings import Settings
from app.models import Alarm, Notification, NotificationKind, NotificationPreferences, RobotRow, Role
from app.notifications.service import tell_dispatchers
from app.robots.alarms import clear_alarms, raise_alarm
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER
from tests.app.notifications.office import Office, running

DISPATCHER = "dispatcher@campus.example"


async def rings(office: Office, reason: str = "the base does not answer") -> None:
    async with office.state.database.transaction() as session:
        if await session.get(RobotRow, "r1") is None:
            session.add(RobotRow(name="r1", enrolled_at=office.clock.utc(), server_journal="j1"))
            await session.flush()
        await raise_alarm(session, "r1", "base_silent", reason, now=office.clock.utc(), post="post2")


async def told(office: Office) -> list[tuple[str, str]]:
    async with office.state.database.reading() as session:
        notices = (await session.exec(select(Notification).order_by(col(Notification.id)))).all()
        return [(one.person_id, one.facts["reason"]) for one in notices if one.kind is NotificationKind.ALARM]


async def test_an_alarm_is_told_to_every_dispatcher_once_while_it_lasts(
    settings: Settings, clock: SteppedClock
) -> None:
    async with running(settings, clock) as office:
        await office.person(SENDER)
        on_duty = await office.person(DISPATCHER, roles=[Role.MEMBER, Role.DISPATCHER])
        await rings(office)
        await rings(office)
        assert await told(office) == [(on_duty.id, "the base does not answer")]
        async with office.state.database.transaction() as session:
            await clear_alarms(session, "r1", "base_silent", clock.utc())
        await rings(office)
        assert len(await told(office)) == 1, "it comes and goes"
        async with office.state.database.transaction() as session:
            await clear_alarms(session, "r1", "base_silent", clock.utc())
        clock.advance(11 * 60)
        await rings(office)
        assert len(await told(office)) == 2, "it has come back"
        await office.settle()
        assert await office.sendings("mail") == [], "the page is open where a dispatcher is on duty"


async def test_who_wants_alarms_by_mail_has_them(settings: Settings, clock: SteppedClock) -> None:
    async with running(settings, clock) as office:
        on_duty = await office.person(DISPATCHER, roles=[Role.MEMBER, Role.DISPATCHER], language="fr")
        await office.add(NotificationPreferences(person_id=on_duty.id, muted={"mail": []}))
        await rings(office)
        await office.settle()
        (mail,) = settings.spool_folder.glob("*.eml")
        assert "Subject: Alarme : robot r1" in mail.read_text()
        assert "follow.html" not in mail.read_text(), "there is no order to follow"


async def test_an_alarm_that_a_dispatcher_has_acknowledged_is_silent(settings: Settings, clock: SteppedClock) -> None:
    async with running(settings, clock) as office:
        await office.person(DISPATCHER, roles=[Role.MEMBER, Role.DISPATCHER])
        await rings(office)
        async with office.state.database.transaction() as session:
            alarm = (await session.exec(select(Alarm))).one()
            alarm.acknowledged_at = clock.utc()
        await rings(office)
        async with office.state.database.transaction() as session:
            await tell_dispatchers(
                session, Alarm(robot="r1", name="x", reason="x", at=clock.utc(), acknowledged_at=clock.utc())
            )
        assert len(await told(office)) == 1
