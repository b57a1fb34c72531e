"""Recipients of each notification, on every way an order can take: both people where both are concerned, once."""

from collections import Counter
from collections.abc import AsyncIterator
from email import message_from_bytes, policy

import pytest
from sqlmodel import col, select

from app.core.settings import Settings
from app.models import Notification, NotificationKind, Order, OrderState, Person
from app.orders.notifications import NOTIFICATION_RULES, ONCE
from app.orders.service import Actor
from app.orders.transitions import TRANSITIONS, By
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER
from tests.app.notifications.office import Office, running

TO_RECIPIENT = ("assigned", "to_sender", "at_sender", "carrying", "at_recipient")


@pytest.fixture
async def office(settings: Settings, clock: SteppedClock) -> AsyncIterator[Office]:
    async with running(settings, clock) as office:
        yield office


async def told(office: Office) -> dict[str, list[str]]:
    async with office.state.database.reading() as session:
        notices = (await session.exec(select(Notification, Person).join(Person).order_by(col(Notification.id)))).all()
    kinds: dict[str, list[str]] = {"Sender": [], "Recipient": []}
    for notice, person in notices:
        kinds[person.name].append(str(notice.kind))
    return kinds


async def says(office: Office, by: By, order_id: str, to: str) -> None:
    async with office.state.database.transaction() as session:
        await office.state.orders.ledger.move(session, order_id, OrderState(to), Actor(by, robot="r1"))


async def test_mail_that_is_taken(office: Office) -> None:
    order_id = await office.order()
    await office.move(order_id, *TO_RECIPIENT, "delivered")
    assert await told(office) == {
        "Sender": ["accepted", "robot_near", "robot_here", "delivered"],
        "Recipient": ["on_its_way", "robot_here_for_you", "delivered"],
    }


async def test_mail_that_no_recipient_takes_and_its_sender_takes_back_by_a_code_of_its_own(office: Office) -> None:
    order_id = await office.order()
    await office.move(order_id, *TO_RECIPIENT, "returning", "at_return", "returned")
    assert (await told(office))["Sender"][3:] == ["not_taken", "at_return", "returned"]
    assert (await told(office))["Recipient"][2:] == ["not_taken", "returned"]
    await office.settle()
    (mail,) = office.state.settings.spool_folder.glob("mail.*.at_return.*.eml")
    assert "return-code.png" in mail.read_text()


async def test_mail_that_waits_in_the_mailroom_is_taken_out_there(office: Office) -> None:
    order_id = await office.order()
    await office.move(order_id, *TO_RECIPIENT)
    async with office.state.database.transaction() as session:
        (await session.get_one(Order, order_id)).return_post = "post5"
    await office.move(order_id, "returning", "at_return", "held")
    assert (await told(office))["Sender"][3:] == ["not_taken", "held"]
    assert (await told(office))["Recipient"][2:] == ["not_taken", "held"]


async def test_mail_that_was_called_back_is_not_said_to_have_been_left(office: Office, clock: SteppedClock) -> None:
    order_id = await office.order()
    await office.move(order_id, *TO_RECIPIENT)
    async with office.state.database.transaction() as session:
        (await session.get_one(Order, order_id)).cancel_requested_at = clock.utc()
    await office.move(order_id, "returning")
    assert (await told(office))["Sender"][-1] == (await told(office))["Recipient"][-1] == "called_back"


async def test_trouble_before_the_mail_is_aboard_is_no_recipients_concern(office: Office) -> None:
    order_id = await office.order()
    await office.move(order_id, "assigned", "to_sender", "attention")
    assert await told(office) == {"Sender": ["accepted", "robot_near", "attention"], "Recipient": []}


async def test_after_a_dispatcher_has_seen_to_it_people_are_told_anew_how_it_goes_on(office: Office) -> None:
    order_id = await office.order()
    await office.move(order_id, *TO_RECIPIENT, "attention")
    await says(office, By.DISPATCHER, order_id, "at_recipient")
    await office.move(order_id, "attention")
    await says(office, By.DISPATCHER, order_id, "at_recipient")
    await office.move(order_id, "delivered")
    kinds = Counter((await told(office))["Recipient"])
    assert kinds == {"on_its_way": 1, "robot_here_for_you": 3, "attention": 2, "delivered": 1}


async def test_whatever_a_robot_repeats_no_person_is_told_twice(office: Office) -> None:
    order_id = await office.order()
    for state in (*TO_RECIPIENT, "delivered"):
        for _ in range(3):
            await office.move(order_id, state)
    await office.move(order_id, "at_sender", "carrying", "at_recipient")
    await office.settle()
    assert all(count == 1 for kinds in (await told(office)).values() for count in Counter(kinds).values())
    assert len(await office.sendings("mail")) == 7


async def test_a_notice_that_cannot_be_put_into_words_holds_up_no_other(office: Office) -> None:
    sender = await office.person(SENDER)
    now = office.clock.utc()
    await office.add(Notification(key="odd", kind=NotificationKind.ACCEPTED, person_id=sender.id, at=now, facts={}))
    await office.order()
    await office.settle()
    odd, good = await office.sendings("mail")
    assert good.sent_at and not odd.sent_at
    assert "KeyError" in (odd.problem or "")


async def test_a_name_with_a_line_of_its_own_writes_no_header(office: Office) -> None:
    await office.person(SENDER, name="Eve\nBcc: all@campus.example")
    order_id = await office.order()
    await office.move(order_id, *TO_RECIPIENT[:4])
    await office.settle()
    (mail,) = office.state.settings.spool_folder.glob("mail.*.on_its_way.*.eml")
    head = message_from_bytes(mail.read_bytes(), policy=policy.default)
    assert head["Bcc"] is None
    assert head["Subject"] == "Mail from Eve Bcc: all@campus.example is on its way to you"


def test_every_end_and_every_wait_is_told() -> None:
    untold = set(TRANSITIONS) - set(NOTIFICATION_RULES)
    assert untold == {OrderState.ASSIGNED}, "the order was accepted; that a robot was chosen concerns neither person"
    ends = {state for state, following in TRANSITIONS.items() if not following}
    assert {rule.kind for end in ends for rule in NOTIFICATION_RULES[end]} <= ONCE
    kinds = {rule.kind for rules in NOTIFICATION_RULES.values() for rule in rules}
    of_delegates = {NotificationKind.DELEGATED, NotificationKind.DELEGATION_OVER}
    assert set(NotificationKind) - kinds == {NotificationKind.DELAYED, NotificationKind.ALARM, *of_delegates}
