"""Which robot has the charge for which order: as map and settings say, and never so that one waits for ever."""

from dataclasses import replace
from typing import Any

from app.core.settings import Settings
from app.dispatch.charge_limits import Charges
from app.dispatch.choice import Assignment, IdleRobot, WaitingOrder, choose_robots, lacks_charge
from maps.ways import Ways
from tests.plain_maps import plain_map

WAYS = Ways(plain_map("carleton"))
CHARGES = Charges(WAYS, Settings())
SHORT = WaitingOrder("short", "canal", "nicol")
LONG = WaitingOrder("long", "loeb", "robertson")


def robot(name: str, ratio: float, post: str = "canal", **more: Any) -> IdleRobot:
    return replace(IdleRobot(name, post, ratio, docked=False, home="canal"), **more)


def test_a_robot_that_is_half_full_takes_the_short_way_and_not_the_long_one() -> None:
    assert CHARGES.may_take(robot("r1", 0.5), SHORT)
    assert not CHARGES.may_take(robot("r1", 0.5), LONG)


def test_the_nearest_that_has_the_charge_fetches_it_and_the_other_is_left_for_what_it_can_do() -> None:
    robots = [robot("low", 0.5), robot("full", 0.99, "cttc", docked=True)]
    chosen = choose_robots([LONG, SHORT], robots, WAYS, CHARGES.may_take)
    assert chosen == [Assignment("long", "full"), Assignment("short", "low")]


def test_in_the_dock_nothing_is_begun_that_the_robot_itself_would_not_begin() -> None:
    assert not CHARGES.may_take(robot("r1", 0.5, docked=True, charging=True), SHORT)
    assert CHARGES.may_take(robot("r1", 0.55, docked=True, charging=True), SHORT)


def test_what_is_more_than_one_charge_goes_with_a_robot_that_is_full() -> None:
    assert not CHARGES.may_take(robot("r1", 0.9, docked=True, charging=True), LONG)
    assert CHARGES.may_take(robot("r1", 0.96, docked=True, charging=True), LONG)


def test_no_robot_waits_for_charge_that_will_not_come() -> None:
    """A worn pack whose charger has ended; a robot that has no home to charge at."""
    assert CHARGES.may_take(robot("worn", 0.9, docked=True), LONG)
    homeless = IdleRobot("r1", "canal", 0.7)
    assert CHARGES.may_take(homeless, LONG)
    assert not CHARGES.may_take(IdleRobot("r1", "canal", 0.4), LONG), "its own battery plan takes it to a dock soon"


def test_an_order_that_waits_for_charge_alone_is_told_so() -> None:
    assert lacks_charge(LONG, [robot("r1", 0.5)], CHARGES.may_take)
    assert not lacks_charge(SHORT, [robot("r1", 0.5)], CHARGES.may_take)
    assert not lacks_charge(LONG, [], CHARGES.may_take), "every robot is busy"
    assert not lacks_charge(LONG, [robot("r1", 0.2)], CHARGES.may_take), "all of them charge first"


def test_where_nothing_is_known_of_a_way_the_charge_is_no_obstacle() -> None:
    assert CHARGES.may_take(IdleRobot("r1", None, 0.9), WaitingOrder("o", "nowhere", "canal"))
    assert not CHARGES.may_take(IdleRobot("r1", "canal", None), SHORT)
