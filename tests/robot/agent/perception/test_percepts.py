"""The percepts of the mind."""

from dataclasses import replace

import pytest

from protocol.parts import Stop, StopAction
from protocol.to_robot import Mission
from robot.agent.perception.battery import BatteryLevel, BatterySense
from robot.agent.perception.percepts import PERCEPTS, atom_or_text, perceive
from robot.agent.perception.seen import MapPosition, Seen
from robot.core.config import PerceptMode
from robot.drivers.interfaces import BaseState
from robot.localization.line_symbol import LineSymbol
from robot.mission.state import Held
from robot.skills.interfaces import View

LATEST, DRAIN = PerceptMode.LATEST, PerceptMode.DRAIN
MISSION = Mission(
    id="m-1",
    update=2,
    stops=(
        Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o-1", wait_limit_s=300),
        Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o-1"),
    ),
)


def seen(now: float = 10.0, *, base_at_s: float = 10.0, **more: object) -> Seen:
    view = View(at_s=now, base=BaseState(at_s=base_at_s), line=LineSymbol.CENTER)
    battery = BatterySense(BatteryLevel.OK, 0.5)
    return replace(Seen(now, view, battery, MapPosition("post2", "post1", "post4", "left", "post2")), **more)


def test_the_papers_words_are_shown_in_both_modes() -> None:
    papers = {"battery(ok)", "line(center)", "postPoint(post2,post1)", "direction(post4,left)"}
    assert perceive(seen(), DRAIN, 2.0) == papers
    assert papers < perceive(seen(), LATEST, 2.0)


def test_before_anything_is_known_the_paper_says_unknown() -> None:
    nowhere = seen(where=MapPosition())
    assert "direction(unknown,unknown)" in perceive(nowhere, DRAIN, 2.0)
    first = seen(where=MapPosition(at="post3", rests_at="post3"))
    assert "postPoint(post3,unknown)" in perceive(first, DRAIN, 2.0)


def test_between_posts_neither_place_nor_direction_is_believed() -> None:
    shown = perceive(seen(where=MapPosition(None, "post1", "post4", None)), LATEST, 2.0)
    assert not [term for term in shown if term.startswith(("at(", "postPoint(", "direction("))]


def test_a_silent_base_does_not_hold_back_the_line() -> None:
    shown = perceive(seen(base_at_s=5.0), LATEST, 2.0)
    assert "line(center)" in shown
    assert not [term for term in shown if term.startswith("battery(")], "five seconds old: not believed any more"


def test_the_mission_is_shown_stop_by_stop_with_how_far_it_has_come() -> None:
    shown = perceive(seen(held=Held(mission=MISSION, next_stop=1, cargo=("o-1",))), LATEST, 2.0)
    assert {
        'mission("m-1",2)',
        'stop(0,s1,post1,load,"o-1",300)',
        'stop(1,s2,post4,receive,"o-1",600)',
        "next_stop(1)",
        'carrying("o-1")',
    } < shown


def test_faults_are_shown_by_name_and_only_grave_ones_halt() -> None:
    bumped = replace(seen().view, faults=frozenset({"bump"}))
    assert "fault(bump)" in perceive(seen(view=bumped), LATEST, 2.0)
    assert "halted" not in perceive(seen(view=bumped), LATEST, 2.0)
    assert "halted" in perceive(seen(halting=frozenset({"cliff"})), LATEST, 2.0)


@pytest.mark.parametrize(("name", "term"), [("post1", "post1"), ("o-1", '"o-1"'), ("7f", '"7f"'), ("R1", '"R1"')])
def test_a_name_is_an_atom_where_it_can_be_one(name: str, term: str) -> None:
    assert atom_or_text(name) == term


def test_every_percept_says_what_it_means() -> None:
    assert [row.name for row in PERCEPTS if not row.about] == []


def test_what_only_our_program_needs_is_shown_to_it_alone() -> None:
    carried_off = seen(
        where=MapPosition(moved="post3"),
        held=Held(recharging=True),
        battery=BatterySense(BatteryLevel.OK, 0.4, weak=True),
    )
    ours = {"moved(post3)", "recharging", "weak"}
    assert ours <= perceive(carried_off, LATEST, 2.0)
    assert not ours & perceive(carried_off, DRAIN, 2.0)


def test_where_no_dock_can_be_reached_none_is_named() -> None:
    assert not [term for term in perceive(seen(), LATEST, 2.0) if term.startswith("nearest_dock")]
