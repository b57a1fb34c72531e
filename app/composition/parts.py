"""Every part of the service, built in reading order, and what wakes what."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, get_type_hints

import httpx
from fastapi import FastAPI

from app.accounts.last_seen import LastSeen
from app.accounts.links import Links
from app.accounts.rate_limits import RateLimits
from app.accounts.sign_in.oidc import Provider
from app.accounts.sign_in.service import SignInService
from app.charging.charge_first import ChargeFirst
from app.charging.service import ChargingService
from app.core.database.database import Database
from app.core.http_client import TIMEOUT_S, HttpClient, trusted_here
from app.core.mail import Mailer, open_mailer
from app.core.server_key import ServerKey, open_server_key
from app.core.settings import Settings, make_data_folder, open_map
from app.dispatch.eta_updates import EtaUpdates
from app.dispatch.fleet_planner import FleetPlanner
from app.dispatch.held_up import NoRobotComes
from app.dispatch.planner_process import PlannerProcess
from app.dispatch.service import Dispatcher
from app.handover.delegates import Delegating
from app.handover.service import HandOvers
from app.http.metrics import Metrics
from app.models import Notification, Person
from app.notifications.channels.mail import Drawing, MailChannel
from app.notifications.channels.push import PushChannel
from app.notifications.channels.webhook import Address, WebhookChannel, secret_bytes
from app.notifications.delivery.worker import OutboxWorker
from app.notifications.push_key import PushKey, open_push_key
from app.orders.batcher import OrderBatcher
from app.orders.custody.codes import code_in_mail, code_png
from app.orders.ledger import Ledger
from app.orders.service import Orders
from app.orders.standing.standing import StandingOrders
from app.orders.timer import Timer
from app.realtime.feed import LocalFeed
from app.retention.retention_job import RetentionJob
from app.robots.conversation.intake import Intake
from app.robots.enrolment.service import EnrolmentService
from app.robots.service import Fleet
from app.traffic.service import TrafficService
from fleet.eta.arrivals import Estimates
from maps import CampusMap
from protocol.clock import Clock


@dataclass
class Parts:
    """The parts of one service, lowest layer first; routes find them by their type (`app.core.parts`).

    Raises StartError if a folder, key, map or address in the settings cannot be used.
    """

    settings: Settings
    clock: Clock
    http_client: HttpClient
    planner_process: PlannerProcess = field(default_factory=PlannerProcess)

    campus: CampusMap = field(init=False)
    server_key: ServerKey = field(init=False)
    database: Database = field(init=False)
    feed: LocalFeed = field(init=False)
    metrics: Metrics = field(init=False)

    last_seen: LastSeen = field(init=False)
    rate_limits: RateLimits = field(init=False)
    mailer: Mailer = field(init=False)
    sign_in_service: SignInService = field(init=False)
    provider: Provider = field(init=False)
    links: Links = field(init=False)

    orders: Orders = field(init=False)
    estimates: Estimates = field(init=False)
    order_batcher: OrderBatcher = field(init=False)
    standing_orders: StandingOrders = field(init=False)
    timer: Timer = field(init=False)

    enrolment_service: EnrolmentService = field(init=False)
    fleet: Fleet = field(init=False)
    intake: Intake = field(init=False)
    hand_overs: HandOvers = field(init=False)
    delegating: Delegating = field(init=False)

    push_key: PushKey = field(init=False)
    public_http: httpx.AsyncClient = field(init=False)
    """Reaches the public network alone."""
    operator_http: httpx.AsyncClient = field(init=False)
    """Reaches the address that the operator set, which may be on the campus's own network."""
    outbox_worker: OutboxWorker = field(init=False)

    traffic_service: TrafficService = field(init=False)
    planner: FleetPlanner = field(init=False)
    charging_service: ChargingService = field(init=False)
    dispatcher: Dispatcher = field(init=False)
    eta_updates: EtaUpdates = field(init=False)
    retention_job: RetentionJob = field(init=False)

    def __post_init__(self) -> None:
        self._add_foundation()
        self._add_accounts()
        self._add_orders()
        self._add_robots()
        self._add_notifications()
        self._add_planning()
        self.retention_job = RetentionJob(self.database, self.settings, self.clock)
        self._connect()

    def _add_foundation(self) -> None:
        make_data_folder(self.settings)
        self.campus = open_map(self.settings)
        self.server_key = open_server_key(self.settings.server_key_path)
        self.database = Database(self.settings.url_of_database)
        self.feed = LocalFeed()
        self.metrics = Metrics(self.clock.utc())

    def _add_accounts(self) -> None:
        self.last_seen = LastSeen(self.database)
        self.rate_limits = RateLimits(self.settings)
        self.mailer = open_mailer(self.settings)
        self.sign_in_service = SignInService(self.settings, self.server_key, self.mailer)
        self.provider = Provider(self.settings, self.server_key)
        self.links = Links(self.database, self.server_key, self.settings, self.clock)

    def _add_orders(self) -> None:
        ledger = Ledger(self.campus, self.settings, self.clock, self.feed)
        self.orders = Orders.of(ledger, self.server_key, self.sign_in_service)
        self.estimates = ledger.estimates
        self.order_batcher = OrderBatcher(self.database, self.orders.placing)
        self.standing_orders = StandingOrders(self.orders.placing, self.clock)
        self.timer = Timer(self.database, self.orders, self.standing_orders)

    def _add_robots(self) -> None:
        self.enrolment_service = EnrolmentService(self.settings, self.campus, self.server_key, self.clock)
        self.fleet = Fleet(self.database, self.campus, self.settings, self.clock, self.feed, self.orders)
        self.intake = Intake(self.fleet)
        self.hand_overs, self.delegating = HandOvers(self.fleet), Delegating(self.fleet, self.sign_in_service)

    def _add_notifications(self) -> None:
        self.push_key = open_push_key(self.settings.push_key_path)
        self.public_http = self.http_client.client()
        self.operator_http = httpx.AsyncClient(verify=trusted_here(), timeout=TIMEOUT_S, trust_env=False)
        settings, url = self.settings, self.settings.webhook_url
        secret = settings.webhook_secret.get_secret_value()
        operator = Address(url, secret_bytes(secret), self.operator_http) if url else None
        channels = (
            MailChannel(self.mailer, settings, self._code_picture, self._link_for),
            PushChannel(self.database, self.public_http, self.push_key, settings.push_contact_or_usual, self.clock),
            WebhookChannel(self.database, self.public_http, self.server_key, self.clock, operator),
        )
        self.outbox_worker = OutboxWorker(
            self.database, self.feed, self.clock, channels, tell_service=operator is not None
        )

    def _add_planning(self) -> None:
        self.traffic_service = TrafficService(self.fleet, ChargeFirst(self.fleet).sends)
        self.planner = FleetPlanner(self.fleet, self.traffic_service, self.planner_process)
        self.charging_service = ChargingService(self.fleet)
        self.dispatcher = Dispatcher(self.fleet, self.planner)
        self.eta_updates = EtaUpdates(self.fleet, self.traffic_service)

    def _connect(self) -> None:
        """Say what each change wakes, in this order. Each is called after the commit of the change."""
        learning, traffic, dispatcher = self.fleet.learning, self.traffic_service, self.dispatcher
        learning.why_none = NoRobotComes(self.fleet).why
        self.orders.ledger.on_change.extend([learning.wake, self.outbox_worker.wake])
        self.orders.ledger.on_change.extend([traffic.wake, self.charging_service.wake])
        self.orders.ledger.on_change.extend([dispatcher.wake, self.eta_updates.wake])
        self.fleet.on_change.extend([learning.wake, traffic.wake, dispatcher.wake_for_robot, self.eta_updates.wake])
        traffic.on_poll.extend([self.planner.notice, dispatcher.wake_for_robot, self.eta_updates.wake])

    async def _link_for(self, person: Person, notice: Notification) -> str | None:
        """Return the link that goes with a mail to a person without an account."""
        return await self.links.url_for(person, notice.order_id) if notice.order_id else None

    def _code_picture(self, notice: Notification) -> Drawing | None:
        """Return the code that goes with a mail, so that it is at hand where there is no network."""
        code = code_in_mail(self.server_key, notice)
        return None if code is None else lambda: (f"{code[0]}-code.png", code_png(code[1]))

    @cached_property
    def by_type(self) -> dict[type[Any], Any]:
        """Every part by its declared type, for `app.core.parts`; `httpx` clients have no type of their own."""
        return {kind: getattr(self, name) for name, kind in get_type_hints(Parts).items() if isinstance(kind, type)}


def parts_of(app: FastAPI) -> Parts:
    """Return the parts of an application that `create_app` made."""
    parts: Parts = app.state.parts
    return parts
