"""Refusals of an enrolment.

NotSignedIn ├── WrongEnrolmentCode
            └── NoEnrolmentCode
NotFound    └── UnknownRobotToken
Conflict    └── NoHomeForRobot
"""

from app.core.errors import Conflict, NotFound, NotSignedIn


class WrongEnrolmentCode(NotSignedIn):
    """A code was made for this name and is still good, but this is not it."""

    code = "wrong_enrolment_code"


class NoEnrolmentCode(NotSignedIn):
    """No code for this name is still good: never made, too old, used, or tried too often."""

    code = "no_enrolment_code"


class UnknownRobotToken(NotFound):
    """This robot has no such token."""

    code = "unknown_robot_token"


class NoHomeForRobot(Conflict):
    """Every home on the map is another robot's: this one could rest nowhere."""

    code = "no_home_for_robot"
