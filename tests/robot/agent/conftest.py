"""Fixtures of the agent's tests."""

import pytest

from robot.mission.store import Store
from tests.robot.agent.walk import Walk


@pytest.fixture
def walk(store: Store) -> Walk:
    walk = Walk(store)
    walk.look()
    return walk
