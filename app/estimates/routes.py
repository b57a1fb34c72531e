"""For those who look after robots: how good the estimates are that people are told."""

from typing import Annotated

from fastapi import APIRouter, Depends
from starlette.requests import HTTPConnection

from app.errors import problems
from app.estimates.arrivals import Estimates
from app.estimates.schemas import EstimateQuality
from app.people.current_user import DispatcherOrMaintainer
from app.people.errors import RoleNeeded

router = APIRouter(tags=["dispatch"])


async def _estimates(connection: HTTPConnection) -> Estimates:
    estimates: Estimates = connection.app.state.orders.estimates
    return estimates


@router.get("/estimates", responses=problems(RoleNeeded))
async def estimate_quality(
    user: DispatcherOrMaintainer, estimates: Annotated[Estimates, Depends(_estimates)]
) -> EstimateQuality:
    """Show how good estimated arrivals were, and how long corridors and stops take."""
    return EstimateQuality.of(estimates)
