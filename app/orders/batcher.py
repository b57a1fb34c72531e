"""Places orders: those that are asked for at the same time together, in one transaction with few statements for all.

A statement for many takes hardly longer than for one. No request waits for others: what comes while one round is
written is the next round. Each is refused alone; if a round fails as a whole, each of its orders is tried by itself.
"""

import asyncio
from collections.abc import Mapping, Sequence
from contextvars import Context
from dataclasses import dataclass, field
from typing import Any, Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.sign_in.service import look_up_people
from app.core.database.database import Database, write_all
from app.core.errors import ServiceError
from app.models import IdempotencyKey, Person
from app.orders.changes.placing import Draft, Placing
from app.orders.idempotency import Answer, Earlier, Running, earlier_answers, key_row
from app.orders.views.schemas import NewOrder, OrderView, etag_of

AT_ONCE: Final = 20


@dataclass(frozen=True)
class Placed:
    """The answer; `again`: to a request that was answered before."""

    view: OrderView
    headers: Mapping[str, str]
    again: bool = False


@dataclass(frozen=True)
class _New:
    """The rows of one new order, and the answer to its request."""

    draft: Draft
    key: Mapping[str, Any]
    placed: Placed


@dataclass(frozen=True)
class _PendingRequest:
    """One request, and the future that its caller awaits."""

    person: Person
    key: str
    request: NewOrder
    outcome: asyncio.Future[Placed]

    @property
    def whose(self) -> tuple[str, str]:
        return self.person.id, self.key

    def end(self, outcome: Placed | Exception) -> None:
        if self.outcome.done():  # the caller waits no longer
            return
        if isinstance(outcome, Exception):
            self.outcome.set_exception(outcome)
        else:
            self.outcome.set_result(outcome)


@dataclass
class OrderBatcher:
    """The entrance for people's requests to place an order."""

    database: Database
    placing: Placing
    running: Running = field(default_factory=Running)
    _waiting: list[_PendingRequest] = field(default_factory=list)
    _at_work: asyncio.Task[None] | None = None

    async def place(self, person: Person, key: str, request: NewOrder) -> Placed:
        """Place an order once for each key, even if the caller is cancelled meanwhile: its key tells the outcome.

        Raises StillRunning, KeyReused, and what `Placing.draft` raises.
        """
        with self.running.only_once(person.id, key):
            asked = _PendingRequest(person, key, request, asyncio.get_running_loop().create_future())
            self._waiting.append(asked)
            if self._at_work is None:
                # Without the first one's context: the request's number in the log would be wrong for the others.
                self._at_work = asyncio.create_task(self._work(), context=Context())
            return await asked.outcome

    async def _work(self) -> None:
        asked: Sequence[_PendingRequest] = ()
        try:
            while self._waiting:
                asked, self._waiting = self._waiting[:AT_ONCE], self._waiting[AT_ONCE:]
                await self._place(asked)
        finally:
            self._at_work = None
            for one in (*asked, *self._waiting):  # cut off: no caller waits for ever
                one.outcome.cancel()
            self._waiting = []

    async def _place(self, asked: Sequence[_PendingRequest]) -> None:
        try:
            outcomes = await self._in_one_transaction(asked)
        except Exception as error:
            if len(asked) == 1:
                asked[0].end(error)
                return
            for one in asked:
                await self._place([one])
        else:
            for one, outcome in zip(asked, outcomes, strict=True):
                one.end(outcome)

    async def _in_one_transaction(self, asked: Sequence[_PendingRequest]) -> list[Placed | ServiceError]:
        async with self.database.transaction() as session:
            earlier = await earlier_answers(session, [one.whose for one in asked], self.placing.ledger.clock.utc())
            known = await look_up_people(session, {address for one in asked for address in one.request.addresses})
            outcomes = [await self._outcome(session, one, earlier.get(one.whose), known) for one in asked]
            new = [one for one in outcomes if isinstance(one, _New)]
            await self.placing.write(session, [one.draft for one in new])
            await write_all(session, IdempotencyKey, [one.key for one in new])
        return [one.placed if isinstance(one, _New) else one for one in outcomes]

    async def _outcome(
        self, session: AsyncSession, asked: _PendingRequest, earlier: Earlier | None, known: dict[str, Person]
    ) -> Placed | _New | ServiceError:
        try:
            if earlier is not None:
                answer = earlier.answer_to(asked.request)
                return Placed(OrderView.model_validate(answer.body), answer.headers, again=True)
            return self._new(asked, await self.placing.draft(session, asked.person, asked.request, known))
        except ServiceError as refusal:
            return refusal

    def _new(self, asked: _PendingRequest, draft: Draft) -> _New:
        view = self.placing.first_view(draft, asked.person)
        headers = {"Location": f"/api/v1/orders/{view.id}", "ETag": etag_of(view)}
        answer = Answer(headers, view.model_dump(mode="json"))
        key = key_row(*asked.whose, asked.request, answer, draft.facts.order.created_at)
        return _New(draft, key, Placed(view, headers))
