"""Routes that change an order under way: its people's, and dispatchers' for one that is stuck."""

from dataclasses import dataclass
from typing import Annotated, Final, Literal

from fastapi import APIRouter, Depends, Header, Response
from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.current_user import CurrentUser, Dispatcher
from app.core.database.database import SessionDep
from app.core.errors import Conflict, answering, problems
from app.core.text_lines import Reason, Text
from app.models import Person, Priority
from app.orders import errors
from app.orders.routes.orders import OrderId, OrdersDep
from app.orders.views.schemas import OrderView, etag_of
from protocol.one_line import ONE_LINE

router = APIRouter(tags=["orders"])
dispatch_router = APIRouter(tags=["dispatch"])

IfMatch = Annotated[str, Header(max_length=200)]
KNOWN: Final = (errors.UnknownOrder, errors.OrderChanged)
LONGEST_WAIT_S: Final = 7200


def _answers(*refusals: type[Conflict]) -> dict[int | str, dict[str, object]]:
    return {**answering(200, "ETag"), **problems(*KNOWN, *refusals)}


@dataclass(frozen=True)
class ChangeRequest:
    """The arguments of every change of an order."""

    order_id: OrderId
    user: CurrentUser
    orders: OrdersDep
    session: SessionDep
    response: Response
    if_match: IfMatch = ""

    @property
    def of(self) -> tuple[AsyncSession, Person, str]:
        return self.session, self.user, self.order_id

    def tagged(self, view: OrderView) -> OrderView:
        """The answer, with the version for the next change."""
        self.response.headers["ETag"] = etag_of(view)
        return view


@dataclass(frozen=True)
class DispatcherRequest(ChangeRequest):
    """The arguments of a change that only a dispatcher makes."""

    user: Dispatcher


ByParty = Annotated[ChangeRequest, Depends()]
ByDispatcher = Annotated[DispatcherRequest, Depends()]


class Body(BaseModel):
    """Exactly what is declared."""

    model_config = ConfigDict(extra="forbid")


class LongerWait(Body):
    """Extension of the robot's wait; null: as much as one may ask for at once."""

    extend_s: Annotated[float, Field(gt=0, le=LONGEST_WAIT_S)] | None = None


class Attention(Body):
    """Why a person has to see to the order."""

    reason: Reason


class Resolution(Body):
    """Outcome for an order that needed attention: on as before, with mail aboard back or into the mailroom's hands,
    without into the queue again or not at all. `handed_over`: mail that its robot says it has not any more, without a
    proof, is with the person who should have it, who was asked."""

    to: Literal["resume", "returning", "held", "queued", "cancelled", "handed_over"]
    reason: Text | None = None


class IntoHands(Body):
    """The mail was taken out by hand."""

    reason: Text | None = None


class PassingOn(Body):
    """The post where the mail was taken out of its robot for another one; null: where that was seen last."""

    post: Annotated[str, StringConstraints(max_length=64, pattern=ONE_LINE)] | None = None
    reason: Text | None = None


class Reassignment(Body):
    """Which robot shall fetch it; null: any other."""

    robot: Annotated[str, StringConstraints(max_length=64, pattern=ONE_LINE)] | None = None


class PriorityChange(Body):
    """Priority over other orders."""

    priority: Priority


@router.post("/orders/{order_id}/recall", responses=_answers(errors.NotRecallable))
async def recall_order(asked: ByParty) -> OrderView:
    """Call mail back that is aboard. It turns round on the robot's word; until then the order goes on."""
    return asked.tagged(await asked.orders.returning.recall(*asked.of, asked.if_match))


@router.post("/orders/{order_id}/not-now", responses=_answers(errors.NotRecallable))
async def say_not_now(asked: ByParty) -> OrderView:
    """Say as the recipient that it does not suit now. The mail goes back, on the robot's word."""
    return asked.tagged(await asked.orders.returning.not_now(*asked.of, asked.if_match))


@router.post("/orders/{order_id}/wait", responses=_answers(errors.NotWaiting, errors.WaitedLongEnough))
async def extend_wait(asked: ByParty, longer: LongerWait) -> OrderView:
    """Let the robot wait longer. The person it waits for may ask a few times, a dispatcher for as much as is needed."""
    return asked.tagged(await asked.orders.waiting.extend_wait(*asked.of, longer.extend_s, asked.if_match))


@dispatch_router.post("/orders/{order_id}/attention", responses=_answers(errors.TransitionRefused))
async def stop_order_for_attention(asked: ByDispatcher, attention: Attention) -> OrderView:
    """Take an order out of its robot's hands, as far as words go. What becomes of it is decided by `resolve`."""
    return asked.tagged(await asked.orders.intervening.stop_for_attention(*asked.of, attention.reason, asked.if_match))


@dispatch_router.post(
    "/orders/{order_id}/resolve",
    responses=_answers(errors.TransitionRefused, errors.NothingToResume, errors.NothingClaimed),
)
async def resolve_order(asked: ByDispatcher, resolution: Resolution) -> OrderView:
    """Decide what becomes of an order that needed attention."""
    return asked.tagged(
        await asked.orders.intervening.resolve(*asked.of, resolution.to, resolution.reason, asked.if_match)
    )


@dispatch_router.post("/orders/{order_id}/hold", responses=_answers(errors.TransitionRefused))
async def hold_order(asked: ByDispatcher, into_hands: IntoHands) -> OrderView:
    """Say that the mail was taken out of the robot by hand and is held in the mailroom."""
    return asked.tagged(await asked.orders.intervening.hold(*asked.of, into_hands.reason, asked.if_match))


@dispatch_router.post(
    "/orders/{order_id}/pass-on",
    responses=_answers(errors.NothingToPassOn) | problems(errors.UnknownPost, errors.SamePost),
)
async def pass_order_on(asked: ByDispatcher, passing_on: PassingOn) -> OrderView:
    """Say that the mail was taken out of its robot at a post, for another robot to carry it on from there."""
    return asked.tagged(
        await asked.orders.passing_on.pass_on(*asked.of, passing_on.post, passing_on.reason, asked.if_match)
    )


@dispatch_router.post(
    "/orders/{order_id}/reassign", responses=_answers(errors.NotReassignable) | problems(errors.UnknownRobotWanted)
)
async def reassign_order(asked: ByDispatcher, reassignment: Reassignment) -> OrderView:
    """Let another robot fetch the mail. The one that is on its way lets go on its own word."""
    return asked.tagged(await asked.orders.intervening.reassign(*asked.of, reassignment.robot, asked.if_match))


@dispatch_router.put("/orders/{order_id}/priority", responses=_answers(errors.TransitionRefused))
async def prioritise_order(asked: ByDispatcher, request: PriorityChange) -> OrderView:
    """Fetch an order sooner than others, or later."""
    return asked.tagged(await asked.orders.intervening.prioritise(*asked.of, request.priority, asked.if_match))
