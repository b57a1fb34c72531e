"""Errors in what a robot does or says.

ServiceError
├── RobotExists      a robot of this name is enrolled already
├── UnknownRobot     no robot of this name is
├── UnknownAlarm     no alarm of this number has rung
├── NoSuchCorridor   the map has no corridor of this name
├── RobotGoesOn      it is there, and drives or could
├── RobotAway        it would hear of it too late
├── RobotTooOld      its software does not know what that is
└── RobotNameInvalid the name cannot stand in a message
FleetError           a message that was understood and cannot be followed; it is recorded, answered and an alarm
├── UnknownMission   the robot speaks of a mission that it was not given
├── UnknownStop      … of a stop that its mission does not have
├── UnknownCommand   … of a command that it was not given
└── UnknownCorridor  … of a corridor that the map does not have
ProtocolError        a message that cannot be taken; the connection is closed, the robot keeps what it had to say
├── WrongRobot       signed in as one robot, speaking as another
├── OutOfTurn        no hello, a second one, or another journal than the one it named
├── SameHome         its home is another robot's
└── MessageGap       one before it is missing
"""

from app.core.errors import Conflict, NotFound, Unprocessable
from protocol.errors import ProtocolError


class RobotExists(Conflict):
    """Two robots of one name could not be told apart."""

    code = "robot_exists"


class UnknownRobot(NotFound):
    """Enrol it first."""

    code = "unknown_robot"


class UnknownAlarm(NotFound):
    """No alarm of this number has rung."""

    code = "unknown_alarm"


class NoSuchCorridor(Unprocessable):
    """Corridors are named by their two posts, in the order of the alphabet."""

    code = "no_such_corridor"


class RobotAway(Conflict):
    """Until it is back, what is to be said may not hold any more. It tries the way again by itself."""

    code = "robot_away"


class RobotTooOld(Conflict):
    """Its software is older than this message. It tries the way again by itself."""

    code = "robot_too_old"


class RobotGoesOn(Conflict):
    """Others might meet it: stop it first."""

    code = "robot_goes_on"


class RobotNameInvalid(Unprocessable):
    """Letters, digits, - and _; at most 64; beginning with a letter or digit."""

    code = "robot_name_invalid"


class FleetError(Exception):
    """The message is sound, but nothing can follow from it. `code` travels to the robot in an `error` message."""

    code = "fleet_error"


class UnknownMission(FleetError):
    """Perhaps the database was put back from an older copy; a person has to look."""

    code = "unknown_mission"


class UnknownStop(FleetError):
    """The robot and the service do not hold the same mission."""

    code = "unknown_stop"


class UnknownCommand(FleetError):
    """A robot answers what it was not asked: no order is cancelled on its word alone."""

    code = "unknown_command"


class UnknownCorridor(FleetError):
    """The robot's map is not the service's."""

    code = "unknown_corridor"


class WrongRobot(ProtocolError):
    """The token is one robot's, the message says it is from another."""

    code = "wrong_robot"


class OutOfTurn(ProtocolError):
    """A connection begins with one `hello`, in time, and stays with the journal that it named."""

    code = "out_of_turn"


class SameHome(ProtocolError):
    """Both robots would drive into one dock: give this one another home, or take back the other's token."""

    code = "same_home"


class NoHomeLeft(ProtocolError):
    """Every home on the map is another robot's: add a bay with `home = true`, or take back a robot's token."""

    code = "no_home_left"


class MessageGap(ProtocolError):
    """A durable message is missing before this one: connect again and resume."""

    code = "message_gap"
