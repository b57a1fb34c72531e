"""Worn wheels: the robot learns from the map's corridors how far it goes while they count a metre."""

import pytest

from robot.localization.way_scale import WayScale


def drives(scale: WayScale, counted_mm: float, length_m: float | None, disturbed: int = 0) -> None:
    scale.set_out(1000.0, 0)
    scale.arrive(1000.0 + counted_mm, length_m, disturbed)


def test_after_three_corridors_it_knows_to_half_a_per_cent_that_its_wheels_are_worn() -> None:
    scale = WayScale()
    assert scale.real_per_counted == 1.0
    for length_m in (3.3, 3.9, 4.1):
        drives(scale, 1000 * length_m / 0.97, length_m)
    assert scale.real_per_counted == pytest.approx(0.97, abs=0.005)


@pytest.mark.parametrize(
    ("counted_mm", "length_m", "disturbed"),
    [(4120.0, 4.0, 1), (4120.0, None, 0), (5500.0, 4.0, 0), (-4000.0, 4.0, 0)],
    ids=["a search on the way", "no marker at the end", "no wheels are so worn", "backwards"],
)
def test_a_way_that_tells_nothing_of_the_wheels_is_left_out(
    counted_mm: float, length_m: float | None, disturbed: int
) -> None:
    scale = WayScale()
    drives(scale, counted_mm, length_m, disturbed)
    assert scale.real_per_counted == 1.0


def test_nothing_is_learnt_from_a_post_that_was_only_supposed() -> None:
    scale = WayScale()
    scale.set_out(None, 0)
    scale.arrive(4120.0, 4.0, 0)
    assert scale.real_per_counted == 1.0
