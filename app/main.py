"""Puts the service together: the parts of the features, their routes, and what runs in the background."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from functools import cache

import httpx
import structlog
from fastapi import APIRouter, FastAPI
from starlette.datastructures import State

from app.accounts import demo_links, directory_routes, my_routes
from app.accounts.last_seen import LastSeen
from app.accounts.links import Links
from app.accounts.rate_limits import RateLimits
from app.accounts.sign_in import oidc_routes
from app.accounts.sign_in import routes as sign_in_routes
from app.accounts.sign_in.oidc import Provider
from app.accounts.sign_in.service import SignInDesk
from app.charging.charge_first import ChargeFirst
from app.charging.service import ChargeDesk
from app.core.database.database import Database
from app.core.database.deadline import RequestDeadline
from app.core.database.schema_version import bring_to_head
from app.core.errors import DATABASE_AWAY, add_error_answers
from app.core.http_client import TIMEOUT_S, Outside, trusted_here
from app.core.mail import open_mailer
from app.core.server_key import ServerKey, open_server_key
from app.core.settings import Settings, make_data_folder, open_map
from app.core.trusted_clock import TrustedClock
from app.dispatch.at_once.nearest import NearestRobots
from app.dispatch.eta_updates import Foreseen
from app.dispatch.fleet_planner import FleetPlanner
from app.dispatch.held_up import NoRobotComes
from app.dispatch.service import Dispatcher
from app.eta import routes as eta_routes
from app.handover import demo_camera, one_order_routes
from app.handover import routes as handover_routes
from app.handover.delegates import Delegating
from app.handover.service import HandOvers
from app.http import about, asset_links, marker_sheets, metrics
from app.http.api_document import DocumentedApi, operation_id
from app.http.body_limit import BodyLimit
from app.http.etags import ETags
from app.http.pages import CompressedPages, SafeHeaders, add_pages, content_security_policy
from app.http.refused_handshakes import RefusedHandshakes
from app.http.request_log import RequestLog
from app.http.request_metrics import RequestFigures
from app.models import Notice, Person
from app.notifications import routes as notification_routes
from app.notifications.channels.mail import CodePicture, Drawing, LinkFor, MailChannel
from app.notifications.channels.push import PushChannel
from app.notifications.channels.webhook import Address, WebhookChannel, secret_bytes
from app.notifications.delivery import routes as delivery_routes
from app.notifications.delivery.worker import FINISH_WITHIN_S, OutboxWorker
from app.notifications.lag import outbox_lag
from app.notifications.preference_api import routes as preference_routes
from app.notifications.push_key import open_push_key
from app.orders.batcher import OrderDesk
from app.orders.custody.codes import code_in_mail, code_png
from app.orders.routes import changes as change_routes
from app.orders.routes import orders as order_routes
from app.orders.routes import standing as standing_order_routes
from app.orders.service import Orders
from app.orders.standing.standing import StandingOrders
from app.orders.timer import Timer
from app.realtime import routes as realtime_routes
from app.realtime.feed import LocalFeed
from app.realtime.feed_position import FeedPosition
from app.retention import order_export
from app.retention.last_record import last_record
from app.retention.retention_job import Housekeeper
from app.robots.conversation.intake import Intake
from app.robots.enrolment import routes as enrolment_routes
from app.robots.enrolment.service import EnrolmentDesk
from app.robots.routes import diagnostics as diagnostics_routes
from app.robots.routes import dispatcher as dispatcher_routes
from app.robots.routes import robots as robot_routes
from app.robots.service import Fleet
from app.traffic import routes as traffic_routes
from app.traffic.service import TrafficDesk
from protocol.clock import Clock

log = structlog.get_logger(__name__)

API = "/api/v1"
ROUTERS = (
    order_routes.router,  # first: routes are looked through in this order, and these are asked for most
    about.api_router,
    sign_in_routes.router,
    oidc_routes.router,
    my_routes.me_router,
    my_routes.address_router,
    my_routes.router,
    directory_routes.address_router,
    directory_routes.router,
    change_routes.router,
    change_routes.dispatch_router,
    standing_order_routes.router,
    one_order_routes.router,
    notification_routes.router,
    preference_routes.router,
    delivery_routes.router,
    realtime_routes.router,
    robot_routes.router,
    dispatcher_routes.router,
    traffic_routes.router,
    traffic_routes.reading_router,
    diagnostics_routes.router,
    diagnostics_routes.upkeep_router,
    eta_routes.router,
    enrolment_routes.router,
    handover_routes.router,
    handover_routes.dispatch_router,
    demo_camera.router,
    order_export.router,
    marker_sheets.router,
)
ROOT_ROUTERS = (about.root_router, asset_links.router, metrics.router)
RESTART_PAUSE_S = 1.0
STOP_WITHIN_S = 2.0


def create_app(settings: Settings, clock: Clock, outside: Outside | None = None) -> FastAPI:
    """The service, ready to be served; `outside` is given by tests alone. Raises StartError."""
    app = DocumentedApi(
        title="Campus Mail",
        summary="Orders, robots and people of a campus.",
        version=about.version(),
        lifespan=_lifespan,
        openapi_url=f"{API}/openapi.json",
        docs_url=None,  # their scripts come from elsewhere, which the pages' policy forbids
        redoc_url=None,
    )
    app.openapi_version = "3.2.0"  # the first that can describe an event stream
    app.state.outside = outside or Outside(settings.outside_ports, settings.outside_refused_networks)
    _add_parts(app, settings, clock)
    add_error_answers(app)
    if settings.demo_door is not None:
        app.include_router(demo_links.router)
    add_pages(app, settings.pages)
    app.router.routes.extend(_all_routes().routes)
    app.add_middleware(RequestFigures, registry=app.state.metrics.registry)
    app.add_middleware(RefusedHandshakes)
    app.add_middleware(FeedPosition, feed=app.state.feed)
    app.add_middleware(ETags)
    app.add_middleware(BodyLimit)
    app.add_middleware(CompressedPages)
    app.add_middleware(SafeHeaders, policy=content_security_policy(settings.pages))
    app.add_middleware(RequestDeadline, wait_s=settings.database_wait_s)
    app.add_middleware(RequestLog)
    return app


@cache
def _all_routes() -> APIRouter:
    """The same in every service of a process: what they depend on is found out with the first request, for 0.1 s."""
    everything = APIRouter(generate_unique_id_function=operation_id)
    for router in ROUTERS:
        everything.include_router(router, prefix=API)
    for router in ROOT_ROUTERS:
        everything.include_router(router)
    return everything


def _add_parts(app: FastAPI, settings: Settings, clock: Clock) -> None:
    """What dependencies find in `app.state`, lowest layer first."""
    make_data_folder(settings)
    state = app.state
    state.settings, state.clock, state.campus = settings, clock, open_map(settings)
    state.server_key = open_server_key(settings.server_key_path)
    state.database = Database(settings.url_of_database)
    state.last_seen = LastSeen(state.database)
    state.feed = LocalFeed()
    state.metrics = metrics.Metrics(clock.utc())
    state.rate_limits = RateLimits(settings)
    state.mailer = open_mailer(settings)
    state.sign_in_desk = SignInDesk(settings, state.server_key, state.mailer)
    state.provider = Provider(settings, state.server_key)
    state.orders = Orders(state.campus, settings, clock, state.feed, state.server_key, state.sign_in_desk)
    state.order_desk = OrderDesk(state.database, state.orders)
    state.standing_orders = StandingOrders(state.orders)
    state.timer = Timer(state.database, state.orders, state.standing_orders)
    state.links = Links(state.database, state.server_key, settings, clock)
    state.enrolment_desk = EnrolmentDesk(settings, state.server_key, clock)
    state.fleet = Fleet(state.database, state.campus, settings, clock, state.feed, state.orders)
    state.fleet.learning.why_none = NoRobotComes(state.fleet).why
    state.orders.on_change.append(state.fleet.learning.wake)
    state.fleet.on_change.append(state.fleet.learning.wake)
    state.hand_overs, state.delegating = HandOvers(state.fleet), Delegating(state.fleet)
    state.intake = Intake(state.fleet)
    state.outbox_worker = _outbox_worker(state, settings, clock)
    state.orders.on_change.append(lambda order_id: state.outbox_worker.wake())
    state.traffic_desk = TrafficDesk(state.fleet) if settings.traffic == "timetable" else None
    state.planner = FleetPlanner(state.fleet, state.traffic_desk) if state.traffic_desk is not None else None
    state.charge_desk = ChargeDesk(state.fleet) if state.traffic_desk is not None else None
    state.dispatcher = Dispatcher(state.fleet, state.planner or NearestRobots(state.fleet))
    if state.traffic_desk is not None:
        state.traffic_desk.on_look.append(state.dispatcher.wake_for_robot)
        state.traffic_desk.charges_first = ChargeFirst(state.fleet).sends
    state.foreseen = Foreseen(state.fleet, state.traffic_desk)
    for changes in (state.fleet.on_change, state.orders.on_change):
        changes.append(state.foreseen.wake)
    if state.traffic_desk is not None:
        state.traffic_desk.on_look.append(state.foreseen.wake)
    state.housekeeper = Housekeeper(state.database, settings, clock)


def _outbox_worker(state: State, settings: Settings, clock: Clock) -> OutboxWorker:
    """The channels that notices take. `state.http` reaches the public network alone."""
    state.push_key, state.http = open_push_key(settings.push_key_path), state.outside.client()
    # Its address was set by the operator, who may well have a program on the campus's own network.
    state.service_http = httpx.AsyncClient(verify=trusted_here(), timeout=TIMEOUT_S, trust_env=False)
    secret = settings.webhook_secret.get_secret_value()
    service = Address(settings.webhook_url, secret_bytes(secret), state.service_http) if settings.webhook_url else None
    channels = (
        MailChannel(state.mailer, settings, _code_picture(state.server_key), _link_for(state.links)),
        PushChannel(state.database, state.http, state.push_key, settings.push_contact_or_usual, clock),
        WebhookChannel(state.database, state.http, state.server_key, clock, service),
    )
    return OutboxWorker(state.database, state.feed, clock, channels, tell_service=service is not None)


def _link_for(links: Links) -> LinkFor:
    """The link that goes with a mail to somebody who has no account."""

    async def link(person: Person, notice: Notice) -> str | None:
        return await links.url_for(person, notice.order_id) if notice.order_id else None

    return link


def _code_picture(key: ServerKey) -> CodePicture:
    """The code that goes with a mail, so that it is at hand where there is no network."""

    def picture(notice: Notice) -> Drawing | None:
        code = code_in_mail(key, notice)
        return None if code is None else lambda: (f"{code[0]}-code.png", code_png(code[1]))

    return picture


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    await bring_to_head(app.state.database)
    await _compare_clock_with_records(app.state)
    await app.state.fleet.begin()
    await app.state.fleet.learning.begin()
    await app.state.fleet.spending.learn()
    state = app.state
    await state.mailer.begin()
    workers = {
        "dispatch": state.dispatcher,
        "timer": state.timer,
        "housekeeping": state.housekeeper,
        "last seen": state.last_seen,
        "estimates": state.fleet.learning,
        "foreseen": state.foreseen,
        "spending": state.fleet.spending,
    }
    if state.traffic_desk is not None:
        workers |= {
            "charging": state.charge_desk,
            "traffic": state.traffic_desk,
            "planning": state.planner,
        }
    background = [asyncio.create_task(_keep_running(name, worker.run)) for name, worker in workers.items()]
    outbox = asyncio.create_task(_keep_running("outbox", state.outbox_worker.run))
    try:
        yield
    finally:
        app.state.feed.close()
        for worker in workers.values():
            worker.stop()
        await _ended(background, STOP_WITHIN_S)
        # The last, so that what the others have just written goes out too.
        state.outbox_worker.stop()
        finishing = asyncio.create_task(state.mailer.finish(FINISH_WITHIN_S))
        await _ended([outbox], FINISH_WITHIN_S + STOP_WITHIN_S)
        await _say_what_is_left(state, await finishing)
        await app.state.http.aclose()
        await app.state.service_http.aclose()
        await app.state.database.close()


async def _compare_clock_with_records(state: State) -> None:
    if isinstance(state.clock, TrustedClock):
        async with state.database.reading() as session:
            state.clock.compare_with_records(await last_record(session))


async def _say_what_is_left(state: State, sign_in_mails: int) -> None:
    """Whoever stops the service for good, to move it or to put it back, has to know what nobody has been told yet."""
    try:
        async with state.database.reading() as session:
            lag = await outbox_lag(session, state.clock.utc())
    except Exception:
        log.exception("the service stops; what is left could not be counted", sign_in_mails_left=sign_in_mails)
    else:
        left = {"notices_left": sum(lag.waiting.values()) + lag.not_routed, "sign_in_mails_left": sign_in_mails}
        log.info("the service stops", **left)


async def _ended(background: list[asyncio.Task[None]], within_s: float) -> None:
    """What runs in the background may finish its transaction, and is cut off only if that takes long.

    A transaction that is cut off keeps SQLite's write lock until its cursor is collected, and so holds up the others.
    """
    await asyncio.wait(background, timeout=within_s)
    for task in background:
        task.cancel()
    await asyncio.gather(*background, return_exceptions=True)


async def _keep_running(name: str, run: Callable[[], Awaitable[None]]) -> None:
    """What runs in the background goes on after a failure, which is logged: notices and robots wait for nobody."""
    while True:
        try:
            return await run()
        except DATABASE_AWAY as error:
            log.warning("background_work_waits_for_the_database", name=name, why=str(error))
            await asyncio.sleep(RESTART_PAUSE_S)
        except Exception:
            log.exception("background work failed and starts again", name=name)
            await asyncio.sleep(RESTART_PAUSE_S)
