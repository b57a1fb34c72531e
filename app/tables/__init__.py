"""Every table of the service, one file per noun, in one folder so that features need not import each other.

Rows are not validated at run time (SQLModel): build them only in services, from a checked request. Without
relationships the unit of work does not order the rows of different tables: flush the one that is referred to first.
"""

from sqlmodel import SQLModel

from app.tables import indexes as indexes
from app.tables.battery_samples import BatterySample
from app.tables.claims import ClaimRow, ClosedCorridor, GrantRow
from app.tables.contacts import Contact
from app.tables.delegates import Delegate, DigitLock
from app.tables.enrolment_codes import EnrolmentCode
from app.tables.forecasts import DurationRow, ForecastRow, ForecastUnderWayRow
from app.tables.handovers import Evidence, Handover, RefusedReceipt, Settled
from app.tables.idempotency_keys import IdempotencyKey
from app.tables.identities import Identity
from app.tables.missions import MissionRow, MissionState, StopRow
from app.tables.notice_wishes import NoticeWishes, PushSubscription, Webhook
from app.tables.notices import Notice, NoticeKind
from app.tables.order_events import OrderEvent
from app.tables.order_links import OrderLink
from app.tables.orders import Order, OrderState, Priority
from app.tables.outbox import OutgoingNotice
from app.tables.people import Person, Role
from app.tables.person_tokens import PersonToken
from app.tables.robot_commands import RobotCommand
from app.tables.robot_messages import MessageToRobot, RobotJournal, RobotMessage
from app.tables.robots import Alarm, RobotRow, RobotToken
from app.tables.sessions import PersonSession
from app.tables.sign_in_codes import SignInCode
from app.tables.standing_orders import StandingOrder

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
    "Notice",
    "NoticeKind",
    "NoticeWishes",
    "Order",
    "OrderEvent",
    "OrderLink",
    "OrderState",
    "OutgoingNotice",
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
