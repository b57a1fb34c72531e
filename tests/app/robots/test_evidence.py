"""Where no robot gets in the time, by its own clock or by the service's; and where nothing is known, nothing is held
against it."""

from datetime import UTC, datetime, timedelta

import pytest

from app.robots.progress.evidence import FASTEST_M_S, TOLD_AT_ONCE_S, Sighting, is_out_of_reach
from maps.ways import Ways
from tests.plain_maps import plain_map

WAYS = Ways(plain_map("carleton"))
NOON = datetime(2026, 1, 5, 12, tzinfo=UTC)
FAR = max(
    ((a, b) for a in WAYS.campus.posts for b in WAYS.campus.posts if a < b), key=lambda pair: WAYS.length_m(*pair)
)
NEEDS_S = (WAYS.length_m(*FAR) - 1.0) / FASTEST_M_S


def after(seconds: float) -> datetime:
    return NOON + timedelta(seconds=seconds)


def judged(robot_s: float, service_s: float, told_late_s: float = 0.0, to: str = FAR[1]) -> bool:
    """Seconds between two hand-overs, by the robot's clock and by the service's."""
    before = Sighting(FAR[0], NOON, after(told_late_s))
    return is_out_of_reach(WAYS, before, Sighting(to, after(robot_s), after(told_late_s + service_s)), TOLD_AT_ONCE_S)


@pytest.mark.parametrize(
    ("robot_s", "service_s", "told_late_s", "expected"),
    [
        pytest.param(0.00017, 3600, 0, True, id="too soon by its own word, whenever that was told"),
        pytest.param(NEEDS_S - 2, NEEDS_S, 0, True, id="faster than the base can drive"),
        pytest.param(NEEDS_S + 1, NEEDS_S + 1, 0, False, id="as fast as the base can drive"),
        pytest.param(NEEDS_S * 2.5, NEEDS_S * 2.5, 0, False, id="as fast as ours drive"),
        pytest.param(NEEDS_S + 600, 0.1, 0, True, id="times made up, but told on the spot"),
        pytest.param(NEEDS_S + 600, NEEDS_S - 5, 0, False, id="told a moment late"),
        pytest.param(NEEDS_S + 600, 0.1, 60, False, id="both told after a tunnel"),
        pytest.param(-3600, 3600, 0, False, id="its clock was put back on the way"),
    ],
)
def test_map_and_time_decide(robot_s: float, service_s: float, told_late_s: float, expected: bool) -> None:
    assert NEEDS_S > 100
    assert judged(robot_s, service_s, told_late_s) is expected


def test_where_no_way_is_known_or_there_is_none_to_drive_nothing_is_too_fast() -> None:
    assert not judged(0, 0, to="a_post_of_another_map")
    assert not judged(0, 0, to=FAR[0])


def test_without_a_time_of_the_services_the_robots_own_decides() -> None:
    seen = Sighting(FAR[0], NOON)
    assert is_out_of_reach(WAYS, seen, Sighting(FAR[1], after(1), after(3600)), TOLD_AT_ONCE_S)
    assert not is_out_of_reach(WAYS, seen, Sighting(FAR[1], after(NEEDS_S + 1), NOON), TOLD_AT_ONCE_S)
