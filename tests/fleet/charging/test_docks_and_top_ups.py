"""Docks are fewer than robots: each robot has one in time, and none stands empty while a robot could use it."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from fleet.charging.curve import ChargeCurve
from fleet.charging.demand import Demand
from fleet.charging.docks import DockPlan, Need, due_s, plan_docks, standing_per_s
from fleet.charging.energy import Use, assumed_rates
from fleet.charging.going_on import Charge
from fleet.charging.levels import Thresholds
from fleet.charging.top_ups import Move, TopUpPolicy, top_ups

RATES = replace(assumed_rates(7200.0, 19_000.0, 0.2), driving_var=0.003, standing_var=0.003)
CURVE, THRESHOLDS = ChargeCurve(10_800.0), Thresholds()
NEAR, FAR = Use(40.0, 200.0), Use(200.0, 1000.0)
HOUR_S = 3600.0
MONDAY = datetime(2026, 1, 5, tzinfo=UTC)


def need(robot: str, ratio: float, dock: str | None = None, ready_s: float = 0.0, **ways: Use) -> Need:
    ways = ways or {"a": NEAR, "b": FAR}
    if dock is not None:
        ways = {**ways, dock: Use()}
    return Need(robot, Charge(ratio, RATES), ready_s, ways, dock)


def planned(*needs: Need, docks: tuple[str, ...] = ("a", "b")) -> DockPlan:
    return plan_docks(needs, docks, CURVE, THRESHOLDS, 0.0)


def moves(*needs: Need, free: str = "ab", is_quiet: bool = False, wanted: int = 0) -> dict[str, str]:
    taken = {dock: next((one.robot for one in needs if one.dock == dock), None) for dock in "ab" if dock not in free}
    policy = TopUpPolicy(is_quiet, wanted)
    return {move.robot: move.dock for move in top_ups(needs, planned(*needs), taken, THRESHOLDS, policy, 0.0)}


def test_who_is_lower_comes_first_and_the_other_in_time() -> None:
    plan = planned(need("r1", 0.6), need("r2", 0.4), docks=("a",))
    assert plan.stays["r2"].from_s == NEAR.time_s
    assert plan.stays["r1"].from_s == plan.stays["r2"].until_s
    assert plan.late_s == 0.0


def test_more_low_robots_than_docks_are_too_late_and_that_is_told() -> None:
    plan = planned(*(need(f"r{number}", 0.3) for number in range(4)), docks=("a",))
    assert plan.late_s > HOUR_S


def test_work_that_ends_when_the_docks_are_taken_makes_the_plan_worse() -> None:
    low = [need("r1", 0.35, dock="a"), need("r2", 0.4)]
    idle, worked = need("r3", 0.9), need("r3", 0.35, ready_s=1800.0)
    before, after = planned(*low, idle, docks=("a",)), planned(*low, worked, docks=("a",))
    assert before.late_s == 0.0
    assert after.late_s > 1.0
    with_more = replace(worked, ways={"a": NEAR, "b": NEAR})
    assert planned(*low, with_more).late_s <= planned(*low, idle).late_s, "with one dock more it fits"


def test_from_where_no_way_leads_to_a_dock_is_told() -> None:
    assert planned(need("r1", 0.9, c=NEAR)).homeless == ("r1",)


def test_the_farther_the_dock_the_earlier_it_is_due() -> None:
    one = need("r1", 0.5)
    assert due_s(one, FAR, THRESHOLDS) - FAR.time_s < due_s(one, NEAR, THRESHOLDS) - NEAR.time_s
    stands_s = due_s(one, Use(), THRESHOLDS)
    assert abs(0.5 - stands_s * standing_per_s(RATES) - THRESHOLDS.low) < 1e-9


@given(st.lists(st.tuples(st.floats(0.3, 1.0), st.sampled_from([None, "a", "b"])), max_size=7))
def test_no_dock_is_two_robots_at_the_same_time(robots: list[tuple[float, str | None]]) -> None:
    needs, docked = [], set()
    for number, (ratio, dock) in enumerate(robots):
        needs.append(need(f"r{number}", ratio, None if dock in docked else dock))
        docked.add(dock)
    stays = sorted(planned(*needs).stays.values(), key=lambda stay: (stay.dock, stay.from_s))
    assert len(stays) == len(needs)
    for one, following in pairwise(stays):
        assert one.dock != following.dock or one.until_s <= following.from_s + 1e-6


def test_a_robot_with_nothing_to_do_charges_lowest_first_at_the_nearest_dock() -> None:
    assert moves(need("r1", 0.6), need("r2", 0.4)) == {"r2": "a", "r1": "b"}
    assert moves(need("r1", 0.6), need("r2", 0.4), free="a") == {"r2": "a"}


def test_in_busy_hours_no_robot_waits_for_the_last_percents_and_in_quiet_ones_all_do() -> None:
    assert moves(need("r1", 0.82)) == {}
    assert moves(need("r1", 0.82), is_quiet=True) == {"r1": "a"}


def test_robots_that_are_wanted_stay_and_only_those_that_can_do_nothing_go() -> None:
    assert moves(need("r1", 0.6), need("r2", 0.7), wanted=2) == {}
    assert moves(need("r1", 0.6), need("r2", 0.7), need("r3", 0.4), wanted=2) == {"r3": "a"}
    assert moves(need("r1", 0.6), need("r2", 0.7), wanted=1) == {"r1": "a"}


def test_who_is_nearly_full_makes_room_and_who_is_not_stays() -> None:
    assert moves(need("r1", 0.9, dock="a"), need("r2", 0.45, a=NEAR), free="b") == {"r2": "a"}
    assert moves(need("r1", 0.6, dock="a"), need("r2", 0.55, a=NEAR), free="b") == {}


def test_who_must_charge_soon_sets_out_even_to_a_dock_that_is_taken() -> None:
    assert moves(need("r1", 0.5, dock="a"), need("r2", 0.27, a=NEAR), free="b") == {"r2": "a"}


def test_no_robot_sets_out_that_would_not_arrive() -> None:
    assert moves(need("r1", 0.45, a=Use(900.0, 4500.0))) != {"r1": "b"}
    assert top_ups(
        [need("r1", 0.3, c=NEAR)], planned(need("r1", 0.3, c=NEAR)), {}, THRESHOLDS, TopUpPolicy(True), 0.0
    ) == [Move("r1", "c")]


def test_quiet_hours_are_learned_and_nothing_is_quiet_that_was_not_learned() -> None:
    demand = Demand()
    assert not demand.is_quiet(MONDAY)
    for hour in range(24 * 14):
        at = MONDAY + timedelta(hours=hour)
        demand.learn(at, 6 if 8 <= at.hour < 18 else 0)
    assert demand.is_quiet(MONDAY + timedelta(days=14, hours=2))
    assert not demand.is_quiet(MONDAY + timedelta(days=14, hours=9))
    assert demand.expected(MONDAY + timedelta(hours=17), 2) == 6.0
    assert not demand.is_quiet(MONDAY + timedelta(hours=7)), "soon it is busy"
