"""The real service on a real port, and a robot that the test plays."""

from collections.abc import AsyncIterator

import pytest

from app.core.settings import Settings
from protocol.clock import SteppedClock
from tests.app.robots.playing import PlayedRobot, Service, serving


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


@pytest.fixture
def robot(clock: SteppedClock) -> PlayedRobot:
    return PlayedRobot(clock)
