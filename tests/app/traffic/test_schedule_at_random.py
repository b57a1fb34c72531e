"""`TrafficSchedule` itself, driven at random: restarts, deaths, stops, withdrawals, closed corridors and late messages.

No two robots meet, nothing raises, and when all is well again each does its work and comes home.
"""

from random import Random

import pytest

from app.core.settings import Settings
from tests.app.robots.messages_world import World
from tests.plain_maps import plain_map

LIVES = 12
STEPS, TROUBLE = 120, 0.25
COME_HOME_WITHIN = 5000
"""Looks. Carleton's corridors take minutes, and each robot has up to three goals left."""


@pytest.mark.parametrize("campus", ["test_track", "carleton"])
@pytest.mark.parametrize("seed", range(LIVES))
@pytest.mark.nightly
def test_no_two_robots_meet_and_all_come_home(settings: Settings, campus: str, seed: int) -> None:
    rng = Random(f"{campus} {seed}")
    world = World(plain_map(campus), settings, rng, robots=rng.randint(2, 4))
    for _ in world.steps(STEPS):
        if rng.random() < TROUBLE:
            world.trouble()
    world.calm()
    for _ in world.steps(COME_HOME_WITHIN):
        if world.is_at_rest:
            break
    assert world.is_at_rest, f"after {world.looks} looks: {world.robots}"
    assert world.served > 0
