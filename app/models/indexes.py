"""Indexes for the questions that are asked all the time, so that none of them grows slower with what is over.

Most ask for what is *not* over (not acknowledged, not cleared, not told), which is little however long the history is:
such an index holds that alone.
"""

from typing import Any, Final

from sqlalchemy import Index, text
from sqlmodel import SQLModel

from app.models.notifications.notifications import Notification
from app.models.orders.orders import Order
from app.models.robots.missions import MissionRow
from app.models.robots.reservations import ClaimRow, GrantRow
from app.models.robots.robot_commands import RobotCommand
from app.models.robots.robot_messages import MessageToRobot
from app.models.robots.robots import Alarm

# A page of "my mail": a walk from the newest on, for what I sent and for what comes to me, and for everybody's.
SENT: Final = ("ix_orders_sent", Order, ("sender_id", "created_at", "id"), None)
COMING: Final = ("ix_orders_coming", Order, ("recipient_id", "created_at", "id"), None)
NEWEST: Final = ("ix_orders_newest", Order, ("created_at", "id"), None)
# What a robot has to do with, whatever it has done in its life.
OF_ROBOT: Final = ("ix_orders_robot_state", Order, ("robot", "state"), None)
MISSIONS: Final = ("ix_missions_robot_state", MissionRow, ("robot", "state"), None)
# What robots are to be told.
LET_GO: Final = ("ix_orders_let_go", Order, ("let_go_by",), "let_go_by IS NOT NULL")
UNTOLD: Final = ("ix_missions_untold", MissionRow, ("state",), "told_update < update_number")
WAITING: Final = ("ix_server_outbox_waiting", MessageToRobot, ("robot", "seq"), "acked_at IS NULL")
UNANSWERED: Final = ("ix_robot_commands_unanswered", RobotCommand, ("robot", "answered_at"), None)
# What lasts.
CLAIMED: Final = ("ix_claims_waiting", ClaimRow, ("robot",), "granted IS NULL")
HELD: Final = ("ix_grants_held", GrantRow, ("robot", "cleared_at"), None)
RINGING: Final = ("ix_alarms_ringing", Alarm, ("robot", "cleared_at"), None)
NAMED: Final = ("ix_alarms_named", Alarm, ("name",), "cleared_at IS NULL")
UNREAD: Final = ("ix_notices_unread", Notification, ("person_id",), "read_at IS NULL")

INDEXES: Final = (
    SENT,
    COMING,
    NEWEST,
    OF_ROBOT,
    MISSIONS,
    LET_GO,
    UNTOLD,
    WAITING,
    UNANSWERED,
    CLAIMED,
    HELD,
    RINGING,
    NAMED,
    UNREAD,
)


def _add(name: str, table: type[SQLModel], columns: tuple[str, ...], only: str | None) -> None:
    of_table: Any = table
    where = None if only is None else text(only)
    named = [of_table.__table__.c[column] for column in columns]
    Index(name, *named, sqlite_where=where, postgresql_where=where)


for _index in INDEXES:
    _add(*_index)
