"""Simulated robots that are closed again after the test."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.robot.skills.track import Drive


@pytest.fixture
def drive() -> Iterator[Callable[..., Drive]]:
    made: list[Drive] = []

    def make(*arguments: Any, **options: Any) -> Drive:
        made.append(Drive(*arguments, **options))
        return made[-1]

    yield make
    for one in made:
        one.close()
