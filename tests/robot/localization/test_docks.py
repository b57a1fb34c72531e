"""The dock that a robot goes to of its own accord: never one in which another is at home."""

from pathlib import Path

import pytest

from maps import find_map
from robot.localization.docks import nearest_dock

TRACK = find_map(Path(__file__).parents[2] / "bays.toml").track


@pytest.mark.parametrize(
    ("here", "home", "nearest"),
    [
        ("post5_bay1", "post5_bay2", "post5_bay2"),
        ("post5_bay1", "post4_bay2", "post2_bay2"),
        ("post5_bay1", None, "post2_bay2"),
        ("post2_bay1", "post5_bay2", "post2_bay2"),
    ],
    ids=["its own", "another's next door", "without a home", "a lent one is nearer"],
)
def test_the_nearest_dock_is_its_own_or_one_that_is_lent(here: str, home: str | None, nearest: str) -> None:
    assert nearest_dock(TRACK, here, home, frozenset()) == nearest
