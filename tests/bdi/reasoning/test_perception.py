"""The two perception modes, sensor by sensor: what an agent believes of values that come in between its cycles."""

import pytest

from bdi import (
    Agent,
    AgentSpeakSyntaxError,
    Drain,
    Latest,
    NotALiteral,
    OtherSensor,
    Perception,
    parse_program,
    parse_term,
)


def test_the_newest_value_of_a_sensor_is_shown() -> None:
    perception = Perception()
    perception.arrived("line(center)", 0.0)
    perception.arrived("battery(80)", 0.0)
    perception.arrived("line(left)", 0.1)
    assert perception.now(0.2) == {"line(left)", "battery(80)"}
    assert perception.now(99.0) == {"line(left)", "battery(80)"}


def test_a_value_that_is_not_renewed_in_time_is_forgotten() -> None:
    perception = Perception(Latest(age_limit_s=2.0), {"map": Latest()})
    perception.arrived("line(center)", 1.0)
    perception.arrived("map(campus)", 1.0)
    assert perception.now(3.0) == {"line(center)", "map(campus)"}
    assert perception.now(3.1) == {"map(campus)"}
    assert perception.now(2.0) == {"map(campus)"}, "what is forgotten does not come back"


def test_what_is_drained_is_shown_once_and_completely() -> None:
    perception = Perception(Drain())
    perception.arrived("post(1)", 0.0)
    perception.arrived("post(2)", 0.0)
    assert perception.now(5.0) == {"post(1)", "post(2)"}
    assert perception.now(5.1) == frozenset()


def test_each_sensor_has_its_own_mode() -> None:
    perception = Perception(Latest(), {"post": Drain()})
    for percept in ("line(center)", "post(uc)"):
        perception.arrived(percept, 0.0)
    assert perception.now(0.1) == {"line(center)", "post(uc)"}
    assert perception.now(0.2) == {"line(center)"}


def test_one_name_can_stand_for_several_sensors() -> None:
    perception = Perception(named_by={"distance": 1})
    for percept in ("distance(left,4)", "distance(right,5)", "distance(left,6)"):
        perception.arrived(percept, 0.0)
    assert perception.now(0.1) == {"distance(left,6)", "distance(right,5)"}


def test_what_is_known_to_be_false_takes_the_place_of_what_was_true() -> None:
    perception = Perception()
    perception.arrived("docked", 0.0)
    perception.arrived("~docked", 0.1)
    assert perception.now(0.2) == {"~docked"}


def test_a_sensor_can_say_several_things_at_once_and_nothing() -> None:
    perception = Perception()
    perception.arrived("line(center)", 0.0)
    perception.replace("fault", ["fault(bump)", "fault(cliff)"], 0.0)
    assert perception.now(0.1) == {"line(center)", "fault(bump)", "fault(cliff)"}
    perception.replace("fault", [], 0.2)
    assert perception.now(0.3) == {"line(center)"}


def test_a_reading_of_another_sensor_is_refused_whole() -> None:
    perception = Perception()
    perception.replace("fault", ["fault(bump)"], 0.0)
    with pytest.raises(OtherSensor, match="line"):
        perception.replace("fault", ["fault(cliff)", "line(center)"], 0.1)
    assert perception.now(0.2) == {"fault(bump)"}


@pytest.mark.parametrize(("percept", "error"), [("line(", AgentSpeakSyntaxError), (7, NotALiteral)])
def test_what_is_no_percept_is_refused_by_name(percept: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        Perception().arrived(percept, 0.0)  # type: ignore[arg-type]


def test_terms_are_shown_as_terms() -> None:
    perception = Perception()
    perception.arrived(parse_term("line(center)"), 0.0)
    perception.arrived(parse_term("line(left)"), 0.0)
    assert perception.now(0.0) == {parse_term("line(left)")}


def test_an_event_means_a_change_in_one_mode_and_an_arrival_in_the_other() -> None:
    """The same stream of values, two agents: the second reacts to every post, though the value is the same."""
    program = parse_program("+line(X) <- .print(line,X). +post(X) <- .print(post,X).")
    said = {}
    for name, post in {"latest": Latest(), "drain": Drain()}.items():
        agent, perception = Agent(program), Perception(Latest(), {"post": post})
        lines: list[str] = []
        for cycle in range(9):
            perception.arrived("line(center)", cycle)
            if cycle in (0, 3):
                perception.arrived("post(uc)", cycle)
            lines += agent.cycle(perception.now(cycle), now=cycle).printed
        said[name] = sorted(lines)
    assert said == {"latest": ["linecenter", "postuc"], "drain": ["linecenter", "postuc", "postuc"]}
