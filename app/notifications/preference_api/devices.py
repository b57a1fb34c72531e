"""The ways to one person that they named themselves: browsers with Web Push, and a webhook."""

from datetime import datetime

from cryptography.hazmat.primitives.asymmetric import ec
from sqlmodel import col, delete, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Person, PushSubscription, Webhook
from app.notifications.channels.push import from_base64
from app.notifications.errors import BadSubscription, NoWebhook, UnknownDevice
from app.notifications.preference_api.schemas import NewDevice, SubscriptionKeys
from protocol.ids import new_id

MOST_DEVICES = 20
AUTH_BYTES = 16
UNCOMPRESSED = 4


def check_keys(keys: SubscriptionKeys) -> None:
    """Raises BadSubscription."""
    try:
        point = from_base64(keys.p256dh)
        ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), point)
        # A compressed point is one as well, but not what browsers give and encryption takes.
        fits = point[0] == UNCOMPRESSED and len(from_base64(keys.auth)) == AUTH_BYTES
    except ValueError:
        fits = False
    if not fits:
        raise BadSubscription("`p256dh` must be a point on P-256 and `auth` 16 bytes, both in URL-safe base64.")


async def add_device(session: AsyncSession, person: Person, wish: NewDevice, now: datetime) -> PushSubscription:
    """A browser that subscribed. The person who is signed in there has it from now on; the oldest of many makes
    room."""
    await session.exec(delete(PushSubscription).where(col(PushSubscription.endpoint) == wish.endpoint))
    for surplus in (await devices_of(session, person.id))[MOST_DEVICES - 1 :]:
        await session.delete(surplus)
    row = PushSubscription(
        id=new_id(),
        person_id=person.id,
        endpoint=wish.endpoint,
        p256dh=wish.keys.p256dh,
        auth=wish.keys.auth,
        created_at=now,
    )
    session.add(row)
    await session.flush()
    return row


async def devices_of(session: AsyncSession, person_id: str) -> list[PushSubscription]:
    """Newest first."""
    theirs = select(PushSubscription).where(PushSubscription.person_id == person_id)
    return list((await session.exec(theirs.order_by(col(PushSubscription.created_at).desc()))).all())


async def remove_device(session: AsyncSession, person: Person, device_id: str) -> None:
    """Raises UnknownDevice, for another's too."""
    row = await session.get(PushSubscription, device_id)
    if row is None or row.person_id != person.id:
        raise UnknownDevice(f"There is no device {device_id} among yours.")
    await session.delete(row)


async def webhook_of(session: AsyncSession, person_id: str) -> Webhook | None:
    return (await session.exec(select(Webhook).where(Webhook.person_id == person_id))).first()


async def set_webhook(session: AsyncSession, person: Person, url: str, now: datetime) -> Webhook:
    """The one webhook of a person. Another address is another webhook, with another secret."""
    row = await webhook_of(session, person.id)
    if row is not None and row.url == url:
        return row
    if row is not None:
        await session.delete(row)
        await session.flush()
    row = Webhook(id=new_id(), person_id=person.id, url=url, created_at=now)
    session.add(row)
    await session.flush()
    return row


async def my_webhook(session: AsyncSession, person: Person) -> Webhook:
    """Raises NoWebhook."""
    row = await webhook_of(session, person.id)
    if row is None:
        raise NoWebhook("You have no webhook.")
    return row


async def remove_webhook(session: AsyncSession, person: Person) -> None:
    """Raises NoWebhook."""
    await session.delete(await my_webhook(session, person))
