"""Scopes of scripts' tokens. A route that is in no row here takes no token at all."""

from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Final

from app.accounts.sessions.same_origin import SAFE_METHODS
from app.models import Role


class Scope(StrEnum):
    """A token does what its scopes allow and its person may do, never more."""

    ORDERS_READ = "orders:read"
    ORDERS_WRITE = "orders:write"
    ROBOTS_READ = "robots:read"
    NOTICES_READ = "notices:read"
    NOTICES_WRITE = "notices:write"
    CONTACTS_READ = "contacts:read"
    LIVE_READ = "live:read"
    DISPATCH = "dispatch"
    MAINTAIN = "maintain"


NOTHING: Final[frozenset[Scope]] = frozenset()
WHATEVER: Final = frozenset(Scope)

OPENED_BY: Final[Mapping[str, tuple[frozenset[Scope], frozenset[Scope]]]] = {
    # tag of the route: any of these to read, any of these to change
    "orders": (frozenset({Scope.ORDERS_READ}), frozenset({Scope.ORDERS_WRITE})),
    "standing orders": (frozenset({Scope.ORDERS_READ}), frozenset({Scope.ORDERS_WRITE})),
    "dispatch": (frozenset({Scope.DISPATCH}), frozenset({Scope.DISPATCH})),
    "robots": (frozenset({Scope.ROBOTS_READ}), frozenset({Scope.DISPATCH, Scope.MAINTAIN})),
    "upkeep": (frozenset({Scope.MAINTAIN}), frozenset({Scope.MAINTAIN})),
    "enrolment": (frozenset({Scope.MAINTAIN}), frozenset({Scope.MAINTAIN})),
    "notices": (frozenset({Scope.NOTICES_READ}), frozenset({Scope.NOTICES_WRITE})),
    "address book": (frozenset({Scope.CONTACTS_READ}), NOTHING),
    "live": (frozenset({Scope.LIVE_READ}), NOTHING),
    "me": (WHATEVER, NOTHING),
}
NEEDED_FOR_ROLE: Final = {Role.DISPATCHER: Scope.DISPATCH, Role.MAINTAINER: Scope.MAINTAIN}


def opened_by(tags: Iterable[str], method: str) -> frozenset[Scope]:
    """The scopes of which any one opens a route with these tags."""
    reads = method in SAFE_METHODS
    rows = [OPENED_BY[tag] for tag in tags if tag in OPENED_BY]
    return frozenset().union(*(to_read if reads else to_change for to_read, to_change in rows))


def narrowed(roles: Iterable[str], scopes: Iterable[str]) -> list[str]:
    """The roles that are left to a person who comes with a token of these scopes."""
    held = set(scopes)
    return [role for role in roles if role == Role.MEMBER or NEEDED_FOR_ROLE[Role(role)] in held]
