"""Simulated days with worn packs, rush hours and closed corridors: no robot is left lying anywhere."""

from benchmarks.fleet.charging import Run, look_at


def test_no_robot_strands_and_no_order_waits_for_a_charge_that_was_not_planned() -> None:
    """Three days; weeks in `make bench-fleet ARGS="charging"`."""
    seen = look_at(Run("predicting", "usual", seed=2, days=3.0))
    assert seen.stranded == 0
    assert seen.unplanned <= 0.02 * seen.orders
    assert seen.orders > 40
    assert seen.delivered >= seen.orders - 4
    assert seen.exceeded <= 0.1 * seen.predicted


def test_the_same_days_go_wrong_without_predicting() -> None:
    """So the world is one in which robots can strand."""
    seen = look_at(Run("reacting", "usual", seed=2, days=3.0))
    assert seen.stranded > 5
    assert seen.unplanned > 5


def test_with_more_orders_than_the_docks_give_charge_for_orders_wait_and_robots_do_not_strand() -> None:
    seen = look_at(Run("predicting", "more_than_docks_give", seed=1, days=2.0))
    assert seen.stranded == 0
    assert seen.unplanned <= 0.02 * seen.orders
    assert seen.waited > 0.1 * seen.orders
