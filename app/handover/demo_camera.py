"""Demonstration only: a person at the page holds their code to the simulated robot's camera."""

import asyncio
import json
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import BaseModel, StringConstraints

from app.accounts.current_user import CurrentUser
from app.core.database.database import ReadingDep
from app.core.errors import Conflict, NotFound, problems
from app.core.settings import SettingsDep
from app.handover.routes import HandOversDep
from app.models import Order
from app.orders.errors import NoCodeForYou, UnknownOrder
from protocol.one_line import ONE_LINE

router = APIRouter(tags=["demo"])

ANSWER_LIMIT_S = 5.0


class NotADemonstration(NotFound):
    """There is no simulated robot to show anything to."""

    code = "not_a_demonstration"


class DoorClosed(Conflict):
    """The simulated robot does not answer, or said no."""

    code = "door_closed"


class ShowCode(BaseModel):
    """Which order's code to show; it must be this person's turn."""

    order_id: Annotated[str, StringConstraints(max_length=64, pattern=ONE_LINE)]


class Shown(BaseModel):
    """The code is before the camera for the next seconds."""

    purpose: str


@router.post(
    "/demo/camera", status_code=202, responses=problems(NotADemonstration, DoorClosed, UnknownOrder, NoCodeForYou)
)
async def show_code(
    request: ShowCode, user: CurrentUser, hand_overs: HandOversDep, session: ReadingDep, settings: SettingsDep
) -> Shown:
    """Hold this person's own code of an order to the camera of the simulated robot."""
    if settings.demo_door is None:
        raise NotADemonstration("This is no demonstration: hold your code to the robot's camera yourself.")
    code = await hand_overs.my_code(session, user, request.order_id)
    order = await session.get_one(Order, request.order_id)
    await knock(_door_of(settings.demo_door, order.robot), {"do": "show_code", "text": code.text(hand_overs.key)})
    return Shown(purpose=code.purpose)


def _door_of(door: Path, robot: str | None) -> Path:
    """The only robot's, or in a folder of several robots' doors the one that is called as the robot is."""
    return door / (robot or "") if door.is_dir() else door


async def knock(door: Path, request: dict[str, Any]) -> dict[str, Any]:
    """One request to the simulated world (a Unix socket, JSON lines), and its answer. Raises DoorClosed."""
    try:
        async with asyncio.timeout(ANSWER_LIMIT_S):
            reader, writer = await asyncio.open_unix_connection(door)
            writer.write(json.dumps(request).encode() + b"\n")
            await writer.drain()
            answer: dict[str, Any] = json.loads(await reader.readline())
            writer.close()
            await writer.wait_closed()
    except (OSError, TimeoutError, ValueError) as error:
        raise DoorClosed(f"The simulated robot does not answer ({type(error).__name__}).") from None
    if not answer.get("ok"):
        raise DoorClosed(f"The simulated robot says: {answer.get('error')}.")
    return answer
