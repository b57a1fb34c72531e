"""A base that is left alone falls asleep: pulses on BRC, or being stirred, keep it awake."""

import pytest

from robot.drivers.interfaces import STOP
from tests.robot.drivers.against_the_byte_machine import Join

SAFE_THEN_START = b"\x83\x80"


@pytest.mark.nightly
def test_pulses_on_brc_keep_it_awake(join: Join) -> None:
    one = join()
    one.robot.set_fault("sleep_after_s", 70.0)
    one.run(200.0)
    assert not one.robot.state()["asleep"] and one.base.health.starts == 1


@pytest.mark.parametrize("switch", ["brc_dead", "brc_only_wakes"])
def test_a_base_that_sleeps_all_the_same_is_noticed(join: Join, switch: str) -> None:
    one = join()
    one.robot.set_fault(switch, True)
    one.robot.set_fault("sleep_after_s", 30.0)
    one.run(29.0)
    assert not one.robot.state()["asleep"]
    one.run(2.0)
    assert one.robot.state()["asleep"]
    if switch == "brc_only_wakes":
        assert one.after_s(5.0) < 5
        assert one.base.health.awoken_by == "wake by BRC"
    else:
        one.run(65.0)
        assert one.base.health.down, "nothing wakes it but a hand"


@pytest.mark.nightly
def test_without_brc_it_is_stirred_every_four_minutes(join: Join) -> None:
    one = join(brc=False)
    one.run(1.0)
    one.take_sent()
    one.run(235.0, tick_s=0.2)
    assert one.take_sent() == b""
    one.run(300.0, tick_s=0.2)
    assert one.take_sent() == 2 * SAFE_THEN_START
    assert not one.robot.state()["asleep"] and one.base.health.starts == 1


@pytest.mark.nightly
def test_without_brc_nothing_is_sent_in_the_dock(join: Join) -> None:
    one = join("dock", brc=False, battery_ratio=0.5)
    one.run(1.0)
    one.take_sent()
    one.run(400.0, tick_s=0.2)
    assert one.take_sent() == b""
    assert one.base.state is not None and one.base.state.charging


def test_a_base_in_use_never_sleeps(join: Join) -> None:
    one = join(brc=False)
    one.robot.set_fault("sleep_after_s", 10.0)
    one.started().run(30.0, STOP)
    assert not one.robot.state()["asleep"]
    assert one.base.health.starts == 1


@pytest.mark.nightly
def test_never_sleeping_is_no_harm(join: Join) -> None:
    one = join(brc=False)
    one.robot.set_fault("never_sleeps", True)
    one.run(320.0, tick_s=0.2)
    assert one.base.health.starts == 1
