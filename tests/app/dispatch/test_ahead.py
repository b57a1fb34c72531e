"""Who carries what waits for a charge: for what people are told of it."""

import pytest

from app.charging.acceptance import Charge
from app.charging.curve import ChargeCurve
from app.charging.energy import Rates, Use
from app.charging.levels import Thresholds
from app.dispatch.planning.ahead import Charging, Dock, Free, carried_ahead
from app.dispatch.planning.scene import OpenOrder, Route
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import street

RATES = Rates(0.0, 2e-4, driving_var=0.0, standing_var=0.0, spread=0.0)
"""A second costs 0.02 %, for certain."""
CURVE = ChargeCurve(10_000.0)
STREET = street(12)


def free(post: int, ratio: float, at_s: float = 0.0) -> Free:
    return Free(post, at_s, Charge(ratio, RATES), CURVE)


def ahead(robots: dict[str, Free], orders: list[OpenOrder], *docks: int, taken_s: float = 0.0) -> dict[str, Route]:
    those = {post: Dock(taken_s) for post in docks}
    return carried_ahead(STREET, robots, orders, Charging(those, Thresholds(), lambda way_s: Use(0.0, way_s)))


def posts(route: Route) -> list[int]:
    return [stop.goal.post for stop in route]


def charge_s(route: Route) -> float:
    return next(stop.goal.handling_s for stop in route if not stop.order)


def test_whoever_has_the_charge_goes_at_once_though_another_is_nearer() -> None:
    carried = ahead({"near": free(1, 0.3), "far": free(9, 0.9)}, [order(0, 2, 4)], 0)
    assert posts(carried["far"]) == [2, 4]
    assert carried["near"] == ()


def test_who_has_not_enough_comes_to_a_dock_first_and_charges_for_just_that() -> None:
    near, far = ([order(0, 1, to)] for to in (2, 11))
    short, long = (ahead({"r0": free(3, 0.31)}, orders, 0)["r0"] for orders in (near, far))
    assert posts(short) == [0, 1, 2]
    assert posts(long) == [0, 1, 11]
    begins = Thresholds().begin + Thresholds().hysteresis
    assert charge_s(short) == pytest.approx(CURVE.time_s(0.25, begins))
    assert charge_s(long) > charge_s(short)


def test_a_dock_that_another_has_is_waited_for() -> None:
    orders = [order(0, 1, 2)]
    alone, behind = (ahead({"r0": free(0, 0.26)}, orders, 0, taken_s=taken_s)["r0"] for taken_s in (0.0, 900.0))
    assert charge_s(behind) == pytest.approx(charge_s(alone) + 900.0)


def test_two_robots_do_not_charge_in_one_dock_at_the_same_time() -> None:
    carried = ahead({"r0": free(0, 0.26), "r1": free(0, 0.26)}, [order(0, 0, 11), order(1, 0, 11)], 0)
    assert sorted(len(route) for route in carried.values()) == [3, 3]
    first_s, second_s = sorted(charge_s(route) for route in carried.values())
    assert second_s == pytest.approx(2 * first_s)


def test_after_an_order_a_robot_has_less_and_is_somewhere_else() -> None:
    carried = ahead({"r0": free(0, 0.95)}, [order(number, 0, 11) for number in range(4)], 0)
    assert [stop.order for stop in carried["r0"]].count("") >= 1
    assert len(carried["r0"]) >= 9
    assert posts(carried["r0"])[:2] == [0, 11]


def test_what_nobody_ever_has_the_charge_for_is_left_out() -> None:
    costly = Rates(0.0, 1e-3, driving_var=0.0, standing_var=0.0, spread=0.0)
    robot = Free(0, 0.0, Charge(1.0, costly), CURVE)
    assert ahead({"r0": robot}, [order(0, 0, 11)], 0) == {"r0": ()}
