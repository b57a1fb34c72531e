"""Refusals of an enrolment.

NotSignedIn ├── WrongEnrolmentCode
            └── NoEnrolmentCode
NotFound    └── UnknownRobotToken
"""

from app.core.errors import NotFound, NotSignedIn


class WrongEnrolmentCode(NotSignedIn):
    """A code was made for this name and is still good, but this is not it."""

    code = "wrong_enrolment_code"


class NoEnrolmentCode(NotSignedIn):
    """No code for this name is still good: never made, too old, used, or tried too often."""

    code = "no_enrolment_code"


class UnknownRobotToken(NotFound):
    """This robot has no such token."""

    code = "unknown_robot_token"
