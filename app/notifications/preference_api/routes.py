"""A person's preferences over HTTP: muted kinds, browsers, a webhook."""

from typing import Annotated, Final

from fastapi import APIRouter, Path
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.current_user import AtBrowser, CurrentUser
from app.accounts.rate_limits import Door, per_person_at_browser
from app.core.database.database import DatabaseDep, ReadingDep, SessionDep
from app.core.errors import problems
from app.core.http_client import HttpClient, TargetRefused
from app.core.parts import part
from app.core.server_key import ServerKey
from app.core.settings import ClockDep
from app.models import NotificationKind, NotificationPreferences, Person
from app.notifications.channels.webhook import secret_of
from app.notifications.errors import BadSubscription, MutedEverywhere, NoWebhook, UnknownDevice
from app.notifications.preference_api import devices
from app.notifications.preference_api.schemas import (
    DeviceView,
    NewDevice,
    NewWebhook,
    NewWebhookView,
    PreferencesRequest,
    PreferencesView,
    TrialView,
    WebhookView,
)
from app.notifications.preference_api.trial import try_webhook
from app.notifications.preferences import CHANNELS, MUST_REACH, is_muted_everywhere, muted_of
from app.notifications.push_key import PushKey

router = APIRouter(tags=["notices"])

CHANGES: Final = [per_person_at_browser(Door.CHANGES)]
"""Each looks a name up, or asks the address behind it."""

DeviceId = Annotated[str, Path(pattern=r"^[0-9a-f]+$", max_length=64)]


PushKeyDep = Annotated[PushKey, part(PushKey)]
HttpClientDep = Annotated[HttpClient, part(HttpClient)]
ServerKeyDep = Annotated[ServerKey, part(ServerKey)]


@router.get("/me/notices", responses=problems(401, 403))
async def my_wishes(user: CurrentUser, session: ReadingDep, key: PushKeyDep) -> PreferencesView:
    """Return what this person is told, and where."""
    return await _view(session, user, key)


@router.put("/me/notices", responses=problems(401, 403, MutedEverywhere))
async def change_my_wishes(
    wish: PreferencesRequest, user: CurrentUser, session: SessionDep, key: PushKeyDep
) -> PreferencesView:
    """Mute kinds of notices on channels. The language is changed by `PATCH /me`."""
    row = await session.get(NotificationPreferences, user.id)
    row = row or NotificationPreferences(person_id=user.id, muted={})
    chosen: dict[str, list[str]] = {
        channel: sorted({str(kind) for kind in kinds}) for channel, kinds in wish.muted.items()
    }
    row.muted = row.muted | chosen
    for kind in sorted(MUST_REACH):
        if is_muted_everywhere(kind, muted_of(row.muted)):
            raise MutedEverywhere(f"{kind} cannot be muted on every channel: a robot stands there with your mail.")
    session.add(row)
    await session.flush()
    return await _view(session, user, key)


async def _view(session: AsyncSession, user: Person, key: PushKey) -> PreferencesView:
    wishes = await session.get(NotificationPreferences, user.id)
    muted = muted_of(wishes.muted if wishes else None)
    hook = await devices.webhook_of(session, user.id)
    return PreferencesView(
        language=user.language,
        kinds=list(NotificationKind),
        must_reach=sorted(MUST_REACH),
        muted={channel: sorted(muted[channel]) for channel in CHANNELS},
        push_key=key.public,
        devices=[DeviceView.of(row) for row in await devices.devices_of(session, user.id)],
        webhook=hook and WebhookView.of(hook),
    )


@router.post(
    "/me/devices",
    status_code=201,
    dependencies=CHANGES,
    responses=problems(401, 403, 429, BadSubscription, TargetRefused),
)
async def add_device(
    wish: NewDevice, user: AtBrowser, database: DatabaseDep, http_client: HttpClientDep, clock: ClockDep
) -> DeviceView:
    """Have notices shown by this browser (Web Push). The same endpoint again takes the place of the first."""
    devices.check_keys(wish.keys)
    await http_client.checked_target(wish.endpoint)  # which may take a while: no transaction is open
    async with database.transaction() as session:
        return DeviceView.of(await devices.add_device(session, user, wish, clock.utc()))


@router.delete("/me/devices/{device_id}", status_code=204, responses=problems(401, 403, UnknownDevice))
async def remove_device(device_id: DeviceId, user: AtBrowser, session: SessionDep) -> None:
    """No more notices there."""
    await devices.remove_device(session, user, device_id)


@router.put("/me/webhook", dependencies=CHANGES, responses=problems(401, 403, 429, TargetRefused))
async def set_webhook(
    wish: NewWebhook,
    user: AtBrowser,
    database: DatabaseDep,
    http_client: HttpClientDep,
    key: ServerKeyDep,
    clock: ClockDep,
) -> NewWebhookView:
    """Have each notice posted to an address, signed with the secret of the answer. Another address, another secret."""
    await http_client.checked_target(wish.url)
    async with database.transaction() as session:
        row = await devices.set_webhook(session, user, wish.url, clock.utc())
    return NewWebhookView(url=row.url, created_at=row.created_at, secret=secret_of(key, row.id))


@router.post(
    "/me/webhook/trial",
    dependencies=CHANGES,
    responses=problems(401, 403, 429, NoWebhook),
)
async def try_my_webhook(
    user: AtBrowser, database: DatabaseDep, http_client: HttpClientDep, key: ServerKeyDep, clock: ClockDep
) -> TrialView:
    """Post something to my webhook now, signed like a notice, and say what it answered."""
    async with database.reading() as session:
        row = await devices.my_webhook(session, user)
    return await try_webhook(http_client, key, row, user, clock.utc())


@router.delete("/me/webhook", status_code=204, responses=problems(401, 403, NoWebhook))
async def remove_webhook(user: AtBrowser, session: SessionDep) -> None:
    """Nothing is posted there any more."""
    await devices.remove_webhook(session, user)
