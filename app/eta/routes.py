"""For those who look after robots: how good the estimates are that people are told."""

from typing import Annotated

from fastapi import APIRouter

from app.accounts.current_user import DispatcherOrMaintainer
from app.accounts.errors import RoleNeeded
from app.core.errors import problems
from app.core.parts import part
from app.eta.schemas import EstimateQuality
from fleet.eta.arrivals import Estimates

router = APIRouter(tags=["dispatch"])


@router.get("/estimates", responses=problems(RoleNeeded))
async def estimate_quality(
    user: DispatcherOrMaintainer, estimates: Annotated[Estimates, part(Estimates)]
) -> EstimateQuality:
    """Show how good estimated arrivals were, and how long corridors and stops take."""
    return EstimateQuality.of(estimates)
