"""Refusals of hand-overs.

NotFound      └── UnknownDelegate
Forbidden     └── NotYoursToDelegate
Unprocessable └── WrongDigits
Conflict      ├── NotYourTurn
              ├── RobotNotThere
              ├── RobotOffline
              ├── RobotTakesNoTaps
              ├── DigitsLocked
              ├── CodesExpired
              ├── TooLateToDelegate
              └── TooManyDelegates
"""

from app.core.errors import Conflict, Forbidden, NotFound, Unprocessable


class UnknownDelegate(NotFound):
    """This order has no such delegate, or it is not this person's to see."""

    code = "unknown_delegate"


class NotYoursToDelegate(Forbidden):
    """The sender names who loads or takes back, the recipient who receives, a dispatcher any."""

    code = "not_yours_to_delegate"


class WrongDigits(Unprocessable):
    """They are of no code that is good now; the sentence says how many tries are left."""

    code = "wrong_digits"


class NotYourTurn(Conflict):
    """It is another person's turn to hand over, or no one's."""

    code = "not_your_turn"


class RobotNotThere(Conflict):
    """The robot has not arrived yet, or has left."""

    code = "robot_not_there"


class RobotOffline(Conflict):
    """What is tapped does not reach the robot. The QR code works without network."""

    code = "robot_offline"


class RobotTakesNoTaps(Conflict):
    """Its software is older than taps. The QR code works."""

    code = "robot_takes_no_taps"


class DigitsLocked(Conflict):
    """Five wrong ones: a dispatcher has to release the digits. The QR code works."""

    code = "digits_locked"


class CodesExpired(Conflict):
    """The codes of this order are too old; a dispatcher has to see to it."""

    code = "codes_expired"


class TooLateToDelegate(Conflict):
    """The hand-over that the delegate would do is over."""

    code = "too_late_to_delegate"


class TooManyDelegates(Conflict):
    """One order has room for ten at a time."""

    code = "too_many_delegates"
