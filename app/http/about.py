"""The service about itself: to pages, to people, to monitoring."""

from datetime import datetime

from fastapi import APIRouter
from fastapi.responses import JSONResponse
from pydantic import BaseModel
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from app.core.database.database import Database, DatabaseDep
from app.core.database.deadline import waiting_at_most
from app.core.database.schema_version import is_at_head
from app.core.errors import problem_answer
from app.core.settings import CampusDep, ClockDep, SettingsDep
from app.core.texts import LANGUAGES
from app.notifications.lag import outbox_lag
from maps import Post
from maps.bays import Bay
from protocol.clock import Clock
from protocol.software import version

api_router = APIRouter(tags=["about"])
root_router = APIRouter(tags=["health"])

OUTBOX_LAG_LIMIT_S = 600.0
WRITE_WITHIN_S = 2.0
"""Real seconds: monitoring that asks if the service is ready does not wait much longer for the answer."""


class About(BaseModel):
    """Facts that pages need before sign-in."""

    name: str
    version: str
    simulated: bool
    demo: bool
    now: datetime
    languages: list[str]
    allowed_domains: list[str]
    campus_sign_in: bool
    map: str


class BayView(BaseModel):
    """A bay on the floor: a spur of tape from its post to (x_m, y_m), where the axle of a robot stands.

    `home`: it is kept for the robot whose home it is. `markers`: how many marker sheets hang there."""

    name: str
    x_m: float
    y_m: float
    home: bool
    dock: bool
    markers: int


class PostView(BaseModel):
    """A post of the map; metres, x to the right, y up. `markers`: how many marker sheets hang there; `network`
    false: no robot is heard there. `bays` is empty where robots stand on the post itself."""

    name: str
    title: str
    x_m: float
    y_m: float
    dock: bool
    mailroom: bool
    markers: int
    network: bool
    bays: list[BayView]


class CorridorView(BaseModel):
    """The line between two posts; `tape` is where it lies, from a to b; `network`: as of a post."""

    name: str
    a: str
    b: str
    length_m: float
    assumed: bool
    network: bool
    tape: list[tuple[float, float]]


class MapView(BaseModel):
    """The campus map that the robots use too."""

    name: str
    title: str
    version: str
    note: str
    posts: list[PostView]
    corridors: list[CorridorView]


@api_router.get("/about")
async def about(settings: SettingsDep, clock: ClockDep, campus: CampusDep) -> About:
    """Name, version, time, languages; `demo` and `simulated` while a demonstration runs."""
    demo = settings.demo_door is not None
    return About(
        name="Campus Mail",
        version=version(),
        simulated=demo,
        demo=demo,
        now=clock.utc(),
        languages=list(LANGUAGES),
        allowed_domains=list(settings.allowed_domains),
        campus_sign_in=bool(settings.oidc_issuer),
        map=campus.name,
    )


@api_router.get("/map")
async def campus_map(campus: CampusDep) -> MapView:
    """Posts and corridors."""
    posts = [_post(post) for post in campus.posts.values()]
    corridors = [CorridorView.model_validate(corridor, from_attributes=True) for corridor in campus.corridors]
    return MapView(
        name=campus.name,
        title=campus.title,
        version=campus.version,
        note=campus.note,
        posts=posts,
        corridors=corridors,
    )


def _post(post: Post) -> PostView:
    return PostView(
        name=post.name,
        title=post.title,
        x_m=post.x_m,
        y_m=post.y_m,
        dock=post.dock is not None,
        mailroom=post.mailroom,
        markers=len(post.markers),
        network=post.network,
        bays=[_bay(bay) for bay in post.spurs],
    )


def _bay(bay: Bay) -> BayView:
    return BayView(
        name=bay.name,
        x_m=bay.x_m,
        y_m=bay.y_m,
        home=bay.home,
        dock=bay.dock is not None,
        markers=len(bay.markers),
    )


@root_router.get("/healthz")
async def healthz() -> dict[str, str]:
    """The process answers."""
    return {"status": "ok"}


@root_router.get("/version")
async def what_version() -> dict[str, str]:
    """The version of the code."""
    return {"version": version()}


@root_router.get("/readyz", response_model=None)
async def readyz(database: DatabaseDep, clock: ClockDep) -> dict[str, str] | JSONResponse:
    """Database reachable and writable, schema at head, mail not piling up."""
    problem = await _what_is_not_ready(database, clock)
    return {"status": "ready"} if problem is None else problem_answer(503, "not_ready", problem)


async def _what_is_not_ready(database: Database, clock: Clock) -> str | None:
    try:
        async with database.reading() as session:
            lag = await outbox_lag(session, clock.utc())
        if not await is_at_head(database):
            return "The schema is not the one of this version: run `python -m app migrate`."
    except SQLAlchemyError as error:
        return f"The database does not answer: {type(error).__name__}."
    try:
        with waiting_at_most(WRITE_WITHIN_S):
            await database.try_to_write()
    except SQLAlchemyError as error:
        return f"The database cannot be written: {error.orig if isinstance(error, DBAPIError) else error}."
    late = lag.oldest_s > OUTBOX_LAG_LIMIT_S
    return f"The oldest notice that a channel still owes is {lag.oldest_s:.0f} s old." if late else None
