"""The real service on a real port, and a robot that the test plays."""

from collections.abc import AsyncIterator

import pytest

from app.settings import Settings
from protocol.clock import SteppedClock
from tests.app.fleet.playing import PlayedRobot, Service, serving


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    for_one_robot = settings.model_copy(update={"traffic": "at_once"})
    async with serving(for_one_robot, clock) as service:
        yield service


@pytest.fixture
def robot(clock: SteppedClock) -> PlayedRobot:
    return PlayedRobot(clock)
