"""What robots report to occupy, as the database keeps it: the last word of each."""

from datetime import datetime

import structlog
from sqlmodel import col, delete
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import OccupancyRow
from app.robots.errors import UnknownCorridor
from maps import CampusMap, CampusMapError
from protocol.to_server import Occupancy

log = structlog.get_logger(__name__)


async def note_occupancy(
    session: AsyncSession, campus: CampusMap, robot: str, message: Occupancy, at: datetime
) -> None:
    """Keep it. Raises UnknownCorridor for a place that the map does not have."""
    _check(campus.track, message)
    row = await session.get(OccupancyRow, robot) or OccupancyRow(robot=robot, kind="", place="", evidence="", at=at)
    row.kind, row.place, row.towards = message.where, message.post, message.towards
    row.evidence, row.way_mm, row.at = message.evidence, message.way_mm, at
    session.add(row)
    log.info("robot_occupies", robot=robot, kind=row.kind, place=row.place, towards=row.towards, evidence=row.evidence)


async def forget_occupancy(session: AsyncSession, robot: str) -> None:
    """A person has looked, and it is not there."""
    await session.exec(delete(OccupancyRow).where(col(OccupancyRow.robot) == robot))


def _check(track: CampusMap, message: Occupancy) -> None:
    try:
        place = track.post(message.post)
        fits = {
            "bay": place.bay_of is not None,
            "crossing": bool(track.bays_of(place.name)),
            "corridor": message.towards is not None and bool(track.corridor(place.name, message.towards)),
        }[message.where]
    except CampusMapError as problem:
        raise UnknownCorridor(str(problem)) from None
    if not fits:
        raise UnknownCorridor(f"on the map {track.name} {message.post} is no {message.where}")
