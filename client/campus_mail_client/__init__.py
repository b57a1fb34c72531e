"""Order, follow and watch campus mail from Python: `CampusMail`, and `AsyncCampusMail` for programs that await.

What the service refuses is raised by name: `campus_mail_client.problems`. What it answers is in
`campus_mail_client.models`.
"""

from campus_mail_client.async_client import AsyncCampusMail
from campus_mail_client.client import CampusMail
from campus_mail_client.errors import CampusMailError, NoAnswer, Problem, UnexpectedAnswer
from campus_mail_client.following import Change
from campus_mail_client.retrying import Retrying

__all__ = [
    "AsyncCampusMail",
    "CampusMail",
    "CampusMailError",
    "Change",
    "NoAnswer",
    "Problem",
    "Retrying",
    "UnexpectedAnswer",
]
