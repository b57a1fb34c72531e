"""Which channels a notice takes: what there is, what its reader wants, and what they have to be told all the same."""

from collections.abc import Collection, Mapping, Sequence
from typing import Final, Literal

from app.models import NotificationKind

ChannelName = Literal["mail", "push", "webhook"]
MAIL: Final = "mail"
PUSH: Final = "push"
WEBHOOK: Final = "webhook"
CHANNELS: Final[tuple[ChannelName, ...]] = (MAIL, PUSH, WEBHOOK)
"""Besides the inbox, which has everything."""

MUTED_AT_FIRST: Final[Mapping[str, frozenset[NotificationKind]]] = {
    # Alarms are many and for those on duty, who have the page open; others choose them elsewhere.
    MAIL: frozenset({NotificationKind.ALARM}),
    PUSH: frozenset({NotificationKind.ALARM}),
    WEBHOOK: frozenset(),
}
MUST_REACH: Final = frozenset({NotificationKind.ROBOT_HERE_FOR_YOU})
"""A robot stands in the tunnel with a person's mail: that cannot be muted everywhere."""


def muted_of(wishes: Mapping[str, Sequence[str]] | None) -> dict[str, frozenset[NotificationKind]]:
    """Everything that a person does not want, by channel."""
    known = {str(kind) for kind in NotificationKind}
    chosen = wishes or {}
    return {
        channel: frozenset(NotificationKind(kind) for kind in chosen[channel] if kind in known)
        if channel in chosen
        else MUTED_AT_FIRST[channel]
        for channel in CHANNELS
    }


def channels_for(
    kind: NotificationKind, wishes: Mapping[str, Sequence[str]] | None, reachable: Collection[str]
) -> tuple[str, ...]:
    """The channels for this kind among those that reach the person; mail reaches everybody."""
    wanted = tuple(channel for channel in CHANNELS if channel in reachable and not _is_muted(kind, channel, wishes))
    return wanted or ((MAIL,) if kind in MUST_REACH else ())


def _is_muted(kind: NotificationKind, channel: str, wishes: Mapping[str, Sequence[str]] | None) -> bool:
    chosen = wishes.get(channel) if wishes else None
    return kind in MUTED_AT_FIRST[channel] if chosen is None else str(kind) in chosen


def is_muted_everywhere(kind: NotificationKind, muted: Mapping[str, Collection[NotificationKind]]) -> bool:
    return all(kind in muted.get(channel, ()) for channel in CHANNELS)
