"""Long lists one page at a time (keyset): the cursor is the place of the last row that was shown, so that what comes or
goes between two pages doubles no row and hides none.

    NEWEST = Sorting("orders", col(Order.created_at), col(Order.id), descending=True)

    @router.get("/orders", responses=PAGED)
    async def list_orders(page: PageDep, session: ReadingDep) -> OrderPage:
        rows, following = await page.of(session, select(Order), NEWEST)
"""

import base64
import hmac
import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Any, Final, Generic, TypeVar

from fastapi import Depends, Query, Request, Response
from pydantic import BaseModel
from sqlalchemy import ColumnElement, tuple_
from sqlmodel import SQLModel
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar
from starlette.datastructures import URL

from app.core.errors import BadRequest, answering
from app.core.parts import find_part
from app.core.server_key import ServerKey

SEAL_BYTES: Final = 9
PAGED: Final = answering(200, "Link")
"""For `responses=`: what every paged list answers besides its body."""

Row = TypeVar("Row", bound=SQLModel)
Item = TypeVar("Item")


class BadCursor(BadRequest):
    """The cursor is not the `next` of an earlier answer of this list."""

    code = "bad_cursor"


class PageOf(BaseModel, Generic[Item]):
    """Some items of a list; `next` is the cursor of the following page, null on the last."""

    items: list[Item]
    next: str | None


class Sorting:
    """The order of a list: by columns that are never null and together tell every row apart; all in one direction."""

    def __init__(self, name: str, *columns: Any, descending: bool = False) -> None:
        self.name, self._columns, self.descending = name, columns, descending

    def order(self) -> list[ColumnElement[Any]]:
        return [column.desc() if self.descending else column.asc() for column in self._columns]

    def beyond(self, place: Sequence[Any]) -> ColumnElement[bool]:
        here = tuple_(*self._columns)
        return here < tuple(place) if self.descending else here > tuple(place)

    def place_of(self, row: SQLModel) -> list[Any]:
        return [getattr(row, column.key) for column in self._columns]


@dataclass(frozen=True)
class Paging:
    """Which page is wanted of the list that the request asks for."""

    limit: int
    cursor: str
    key: ServerKey
    url: URL
    response: Response

    async def of(
        self, session: AsyncSession, wanted: SelectOfScalar[Row], sorting: Sorting
    ) -> tuple[list[Row], str | None]:
        """The rows of this page and the cursor of the next, which the Link header names too. Raises BadCursor."""
        return await self.of_any(session, [wanted], sorting)

    async def of_any(
        self, session: AsyncSession, wishes: Sequence[SelectOfScalar[Row]], sorting: Sorting
    ) -> tuple[list[Row], str | None]:
        """The same for the rows that any of `wishes` finds: each is a walk along an index of its own, where one
        question with an `or` would have to read and sort all that there is."""
        place = self.place(sorting.name)
        beyond = [sorting.beyond(place)] if place else []
        found: dict[tuple[Any, ...], Row] = {}
        for wanted in wishes:
            # One more than is shown tells whether there is a next page.
            walk = wanted.where(*beyond).order_by(*sorting.order()).limit(self.limit + 1)
            found |= {tuple(sorting.place_of(row)): row for row in (await session.exec(walk)).all()}
        # One walk is in the database's own order, which for words may be another than ours.
        in_order = list(found) if len(wishes) == 1 else sorted(found, reverse=sorting.descending)
        rows = [found[place] for place in in_order[: self.limit]]
        if len(found) == len(rows):
            return rows, None
        return rows, self.following(sorting.name, sorting.place_of(rows[-1]))

    def place(self, name: str) -> list[Any] | None:
        """Of the last row on the page before; None on the first. Raises BadCursor."""
        return _opened(self.key, name, self.cursor) if self.cursor else None

    def following(self, name: str, place: Sequence[Any]) -> str:
        """The cursor of the next page, which the Link header names too; `place` is that of the last row on this one."""
        cursor = _sealed(self.key, name, place)
        url = self.url.include_query_params(cursor=cursor)
        self.response.headers["Link"] = f'<{url.path}?{url.query}>; rel="next"'
        return cursor


def _sealed(key: ServerKey, name: str, place: Sequence[Any]) -> str:
    text = json.dumps(place, default=_moment, separators=(",", ":"))
    return base64.urlsafe_b64encode(_seal(key, name, text) + text.encode()).decode().rstrip("=")


def _moment(at: datetime) -> dict[str, str]:
    return {"at": at.isoformat()}


def _opened(key: ServerKey, name: str, cursor: str) -> list[Any]:
    """A cursor is what was given out for this list or nothing: no made-up place reaches the database."""
    try:
        raw = base64.urlsafe_b64decode(cursor + "=" * (-len(cursor) % 4))
        seal, text = raw[:SEAL_BYTES], raw[SEAL_BYTES:].decode()
    except ValueError:
        seal, text = b"", ""
    if not hmac.compare_digest(seal, _seal(key, name, text)):
        raise BadCursor("This cursor did not come from `next` of an earlier answer of this list.")
    place: list[Any] = json.loads(text, object_hook=lambda moment: datetime.fromisoformat(moment["at"]))
    return place


def _seal(key: ServerKey, name: str, text: str) -> bytes:
    return key.derive("cursor", name, text)[:SEAL_BYTES]


async def _asked(
    request: Request,
    response: Response,
    limit: Annotated[int, Query(ge=1, le=100, description="At most this many items.")] = 20,
    cursor: Annotated[str, Query(max_length=400, description="`next` of the page before; empty for the first.")] = "",
) -> Paging:
    return Paging(limit, cursor, find_part(request, ServerKey), request.url, response)


PageDep = Annotated[Paging, Depends(_asked)]
