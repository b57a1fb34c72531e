"""Every table of the service, one file per noun, in one folder so that features need not import each other.

Rows are not validated at run time (SQLModel): build them only in services, from a checked request. Without
relationships the unit of work does not order the rows of different tables: flush the one that is referred to first.
"""

from sqlmodel import SQLModel

from app.models import indexes as indexes
from app.models.accounts.contacts import Contact
from app.models.accounts.identities import Identity
from app.models.accounts.people import Person, Role
from app.models.accounts.person_tokens import PersonToken
from app.models.accounts.sessions import PersonSession
from app.models.accounts.sign_in_codes import SignInCode
from app.models.notifications.notifications import Notification, NotificationKind
from app.models.notifications.outbox import OutgoingNotification
from app.models.notifications.preferences import NotificationPreferences, PushSubscription, Webhook
from app.models.orders.delegates import Delegate, DigitLock
from app.models.orders.handovers import Evidence, Handover, RefusedReceipt, Settled
from app.models.orders.idempotency_keys import IdempotencyKey
from app.models.orders.order_events import OrderEvent
from app.models.orders.order_links import OrderLink
from app.models.orders.orders import Order, OrderState, Priority
from app.models.orders.standing_orders import StandingOrder
from app.models.robots.battery_samples import BatterySample
from app.models.robots.enrolment_codes import EnrolmentCode
from app.models.robots.forecasts import DurationRow, ForecastRow, ForecastUnderWayRow
from app.models.robots.missions import MissionRow, MissionState, StopRow
from app.models.robots.occupancies import OccupancyRow
from app.models.robots.reservations import ClaimRow, ClosedCorridor, GrantRow
from app.models.robots.robot_commands import RobotCommand
from app.models.robots.robot_messages import MessageToRobot, RobotJournal, RobotMessage
from app.models.robots.robots import Alarm, RobotRow, RobotToken

metadata = SQLModel.metadata

__all__ = [
    "Alarm",
    "BatterySample",
    "ClaimRow",
    "ClosedCorridor",
    "Contact",
    "Delegate",
    "DigitLock",
    "DurationRow",
    "EnrolmentCode",
    "Evidence",
    "ForecastRow",
    "ForecastUnderWayRow",
    "GrantRow",
    "Handover",
    "IdempotencyKey",
    "Identity",
    "MessageToRobot",
    "MissionRow",
    "MissionState",
    "Notification",
    "NotificationKind",
    "NotificationPreferences",
    "OccupancyRow",
    "Order",
    "OrderEvent",
    "OrderLink",
    "OrderState",
    "OutgoingNotification",
    "Person",
    "PersonSession",
    "PersonToken",
    "Priority",
    "PushSubscription",
    "RefusedReceipt",
    "RobotCommand",
    "RobotJournal",
    "RobotMessage",
    "RobotRow",
    "RobotToken",
    "Role",
    "Settled",
    "SignInCode",
    "StandingOrder",
    "StopRow",
    "Webhook",
    "metadata",
]
