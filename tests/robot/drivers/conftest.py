"""Driver and byte machine joined by memory."""

from collections.abc import Callable, Iterator

import pytest

from tests.robot.drivers.against_the_byte_machine import Together


@pytest.fixture
def join() -> Iterator[Callable[..., Together]]:
    made: list[Together] = []

    def together(*args: str, **more: float) -> Together:
        made.append(Together(*args, **more))  # type: ignore[arg-type]
        return made[-1]

    yield together
    for one in made:
        one.close()
