"""Lives of orders at random, where the planner gives them to robots, and takes them back for better ones."""

import os

import pytest
from hypothesis import HealthCheck, Phase, settings

from tests.app.orders.test_lives_at_random import LivesOfOrders


class LivesByTimetable(LivesOfOrders):
    traffic = "timetable"


LivesByTimetable.TestCase.settings = settings(
    max_examples=int(os.environ.get("CAMPUS_MAIL_LIVES", "3")),
    phases=[phase for phase in Phase if phase is not Phase.shrink or os.environ.get("CAMPUS_MAIL_SHRINK")],
    stateful_step_count=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
TestLivesByTimetable = pytest.mark.timeout(400)(LivesByTimetable.TestCase)
