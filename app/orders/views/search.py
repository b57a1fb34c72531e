"""Filters of order lists: side, state and search text.

What has ended is nearly all that there is, and is walked along an index of its time; what goes on is little, and is
found by its state.
"""

from dataclasses import dataclass
from typing import Any, Final, Literal

from sqlalchemy import ColumnElement, or_
from sqlmodel import col, select
from sqlmodel.sql.expression import SelectOfScalar

from app.accounts.search import says
from app.models import Order, OrderState, Person, Role
from app.orders.transitions import ENDED
from maps import CampusMap

RoleInList = Literal["sent", "coming", "all"]
StateInList = Literal["open", "attention", "ended", "all"]
OPEN: Final = tuple(sorted(frozenset(OrderState) - ENDED))
FEW: Final = {"open": OPEN, "attention": (OrderState.ATTENTION,)}


@dataclass(frozen=True)
class OrderFilter:
    """Filter of the orders that a person may see."""

    role: RoleInList
    state: StateInList
    search: str

    def walks(self, user: Person, campus: CampusMap) -> list[SelectOfScalar[Order]]:
        """One question for each side of the orders; a dispatcher's `all` is everybody's."""
        if self.role == "all" and user.has_role(Role.DISPATCHER):
            return [self._narrowed(select(Order), campus, Order.sender_id, Order.recipient_id)]
        sides = {"sent": (Order.sender_id, Order.recipient_id), "coming": (Order.recipient_id, Order.sender_id)}
        wanted = ("sent", "coming") if self.role == "all" else (self.role,)
        return [self._of_side(user, campus, *sides[side]) for side in wanted]

    def _of_side(self, user: Person, campus: CampusMap, mine: Any, other: Any) -> SelectOfScalar[Order]:
        # With something put behind it the person's own index, which holds all that has ended, is of no use.
        whose = col(mine).concat("") if self.state in FEW else col(mine)
        return self._narrowed(select(Order).where(whose == user.id), campus, other)

    def _narrowed(self, wanted: SelectOfScalar[Order], campus: CampusMap, *people: Any) -> SelectOfScalar[Order]:
        if self.state in FEW:
            wanted = wanted.where(col(Order.state).in_(FEW[self.state]))
        elif self.state == "ended":
            wanted = wanted.where(col(Order.state).not_in(OPEN))
        return wanted.where(_matches_text(self.search, campus, *people)) if self.search else wanted


def _matches_text(search: str, campus: CampusMap, *people: Any) -> ColumnElement[bool]:
    """Match the description, one of these people, or a post by its title."""
    found = select(Person.id).where(says(search, Person.name, Person.email))
    sought = search.casefold()
    posts = [post.name for post in campus.posts.values() if sought in f"{post.name}\n{post.title}".casefold()]
    return or_(
        says(search, Order.description),
        *(col(side).in_(found) for side in people),
        col(Order.from_post).in_(posts),
        col(Order.to_post).in_(posts),
    )
