"""Low, ok and full: as the agent perceives the battery."""

from dataclasses import replace

from robot.agent.perception.battery import BatteryLevel, BatterySense
from robot.core.config import BatterySettings
from robot.drivers.interfaces import BaseState, ChargingState

SETTINGS = BatterySettings()


def frame(ratio: float, **more: object) -> BaseState:
    return replace(BaseState(at_s=0.0, charge_mah=round(1000 * ratio), capacity_mah=1000), **more)


def words(ratios: list[float]) -> list[str]:
    sense, seen = BatterySense(), []
    for second, ratio in enumerate(ratios):
        sense = sense.seen(frame(ratio), SETTINGS, float(second))
        seen.append(str(sense.word))
    return seen


def test_a_battery_that_trembles_about_the_threshold_becomes_low_once() -> None:
    assert words([0.26, 0.249, 0.251, 0.249, 0.27, 0.281]) == ["ok", "low", "low", "low", "low", "ok"]


def test_full_is_nearly_everything_and_not_exactly_one() -> None:
    assert words([0.98, 0.99, 1.0, 0.98]) == ["ok", "full", "full", "ok"]


def test_a_worn_pack_is_full_when_the_charger_has_said_so_for_a_minute() -> None:
    sense = BatterySense()
    for second in range(0, 59):
        sense = sense.seen(frame(0.8, home_base=True, charging_state=ChargingState.TRICKLE), SETTINGS, float(second))
        assert sense.word is BatteryLevel.OK
    sense = sense.seen(frame(0.8, home_base=True, charging_state=ChargingState.WAITING), SETTINGS, 60.0)
    assert sense.word is BatteryLevel.FULL


def test_a_charger_that_is_interrupted_counts_its_minute_anew() -> None:
    sense = BatterySense()
    for second, docked in [(0.0, True), (30.0, False), (40.0, True), (70.0, True)]:
        state = ChargingState.TRICKLE if docked else ChargingState.NOT_CHARGING
        sense = sense.seen(frame(0.8, home_base=docked, charging_state=state), SETTINGS, second)
    assert sense.word is BatteryLevel.OK


def test_a_base_that_does_not_know_its_capacity_yet_changes_nothing() -> None:
    low = BatterySense().seen(frame(0.2), SETTINGS, 0.0)
    assert low.seen(BaseState(at_s=1.0, capacity_mah=0), SETTINGS, 1.0).word is BatteryLevel.LOW


def test_too_weak_to_begin_work_ends_a_little_above_where_it_began() -> None:
    sense, weak = BatterySense(), []
    for second, ratio in enumerate([0.51, 0.49, 0.51, 0.529, 0.531, 0.51]):
        sense = sense.seen(frame(ratio), SETTINGS, float(second))
        weak.append(sense.weak)
    assert weak == [False, True, True, True, False, False]


def test_a_worn_pack_that_its_charger_calls_full_is_enough_to_begin_work() -> None:
    sense = BatterySense()
    for second in (0.0, 60.0):
        sense = sense.seen(frame(0.4, home_base=True, charging_state=ChargingState.TRICKLE), SETTINGS, second)
    assert not sense.weak
