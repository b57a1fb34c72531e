"""The application: routes of every feature, and the middleware around them."""

from functools import cache

from fastapi import APIRouter, FastAPI

from app.accounts import demo_links, directory_routes, my_routes
from app.accounts.sign_in import oidc_routes
from app.accounts.sign_in import routes as sign_in_routes
from app.composition.background import lifespan
from app.composition.parts import Parts
from app.core.database.deadline import RequestDeadline
from app.core.errors import add_error_answers
from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.eta import routes as eta_routes
from app.handover import demo_camera, one_order_routes
from app.handover import routes as handover_routes
from app.http import about, asset_links, marker_sheets, metrics
from app.http.api_document import DocumentedApi, operation_id
from app.http.body_limit import BodyLimit
from app.http.etags import ETags
from app.http.pages import CompressedPages, SafeHeaders, add_pages, content_security_policy
from app.http.refused_handshakes import RefusedHandshakes
from app.http.request_log import RequestLog
from app.http.request_metrics import RequestFigures
from app.notifications import routes as notification_routes
from app.notifications.delivery import routes as delivery_routes
from app.notifications.preference_api import routes as preference_routes
from app.orders.routes import changes as change_routes
from app.orders.routes import orders as order_routes
from app.orders.routes import standing as standing_order_routes
from app.realtime import routes as realtime_routes
from app.realtime.feed_position import FeedPosition
from app.retention import order_export
from app.robots.enrolment import routes as enrolment_routes
from app.robots.routes import diagnostics as diagnostics_routes
from app.robots.routes import dispatcher as dispatcher_routes
from app.robots.routes import robots as robot_routes
from app.traffic import routes as traffic_routes
from protocol.clock import Clock
from protocol.software import version

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


def create_app(settings: Settings, clock: Clock, http_client: HttpClient | None = None) -> FastAPI:
    """The service, ready to be served; `http_client` is given by tests alone. Raises StartError."""
    app = DocumentedApi(
        title="Campus Mail",
        summary="Orders, robots and people of a campus.",
        version=version(),
        lifespan=lifespan,
        openapi_url=f"{API}/openapi.json",
        docs_url=None,  # their scripts come from elsewhere, which the pages' policy forbids
        redoc_url=None,
    )
    app.openapi_version = "3.2.0"  # the first that can describe an event stream
    app.state.parts = parts = Parts(
        settings, clock, http_client or HttpClient(settings.outside_ports, settings.outside_refused_networks)
    )
    add_error_answers(app)
    if settings.demo_door is not None:
        app.include_router(demo_links.router)
    add_pages(app, settings.pages)
    app.router.routes.extend(_all_routes().routes)
    app.add_middleware(RequestFigures, registry=parts.metrics.registry)
    app.add_middleware(RefusedHandshakes)
    app.add_middleware(FeedPosition, feed=parts.feed)
    app.add_middleware(ETags)
    app.add_middleware(BodyLimit)
    app.add_middleware(CompressedPages)
    app.add_middleware(SafeHeaders, policy=content_security_policy(settings.pages))
    app.add_middleware(RequestDeadline, wait_s=settings.database_wait_s)
    app.add_middleware(RequestLog)
    return app


@cache
def _all_routes() -> APIRouter:
    """Return all routes, the same for every service of a process: FastAPI analyses them for 0.1 s."""
    everything = APIRouter(generate_unique_id_function=operation_id)
    for router in ROUTERS:
        everything.include_router(router, prefix=API)
    for router in ROOT_ROUTERS:
        everything.include_router(router)
    return everything
