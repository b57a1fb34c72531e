"""`.wait` for a moment, an event or a formula; what comes of it when its goal is suspended or dropped."""

import pytest

from bdi import Agent, parse_program


def said(program: str, cycles: int = 40, percepts: dict[int, set[str]] | None = None) -> list[str]:
    """ "SECONDS line" for everything printed; a cycle takes 0.1 s."""
    agent = Agent(parse_program(program))
    lines: list[str] = []
    for cycle in range(1, cycles + 1):
        outcome = agent.cycle((percepts or {}).get(cycle), (), (), cycle / 10)
        lines += [f"{cycle / 10:g} {line}" for line in outcome.printed]
    return lines


def test_milliseconds_are_of_the_clock_that_the_agent_is_given() -> None:
    assert said("!g. +!g <- .wait(500); .print(a).") == ["0.6 a"]
    assert said("!g. +!g <- X = 2; .wait(X*100+100); .print(a).") == ["0.5 a"]


def test_no_time_at_all_is_over_in_the_next_cycle() -> None:
    assert said("!g. +!g <- .wait(0); .print(a).") == ["0.2 a"]


def test_an_event_gives_its_variables_their_values() -> None:
    program = '!g. !s. +!g <- .wait("+b(X,Y)"); .print(X,Y). +!s <- .wait(500); +b(1,2).'
    assert said(program) == said(program.replace('"+b(X,Y)"', "{+b(X,Y)}"))
    assert [line.split()[1] for line in said(program)] == ["12"]


def test_what_has_a_value_already_must_be_the_same() -> None:
    program = "!g. !s. +!g <- X = 2; .wait({+b(X)}); .print(X). +!s <- .wait(300); +b(1); .wait(300); +b(2)."
    assert [line.split()[1] for line in said(program)] == ["2"]
    assert said(program) == said(program.replace("{+b(X)}", '"+b(X)"'))
    assert float(said(program)[0].split()[0]) > 0.7


@pytest.mark.parametrize(
    ("event", "cause"),
    [
        ("-door(open)", "-door(open)"),
        ("+!go(uc)", "!go(uc)"),
        ("+!go(uc)", "!!go(uc)"),
        ("-!go(lost)", "!go(lost)"),
        ("+?where(_)", "?where(_)"),
        ("+new[source(self)]", "++new"),
    ],
)
def test_any_kind_of_event_can_be_waited_for(event: str, cause: str) -> None:
    program = f"""door(open). !g. !s. +!g <- .wait("{event}"); .print(heard). +!s <- .wait(300); {cause}.
        +!go(uc). -!go(_). +?where(uc)."""
    assert [line.split()[1] for line in said(program)] == ["heard"]


def test_percepts_can_be_waited_for() -> None:
    percepts = {5: {"bumped"}, 8: set[str]()}
    assert said("!g. +!g <- .wait({+bumped}); .print(a); .wait({-bumped}); .print(b).", percepts=percepts) == [
        "0.5 a",
        "0.8 b",
    ]


def test_a_formula_that_holds_is_not_waited_for() -> None:
    assert said("b(5). !g. +!g <- .wait(b(X) & X > 2); .print(X).") == ["0.2 5"]


def test_a_formula_gives_its_variables_the_values_of_the_first_answer() -> None:
    program = "!g. !s. +!g <- .wait(b(X) & X > 2); .print(X). +!s <- +b(1); .wait(300); +b(4)."
    assert [line.split()[1] for line in said(program)] == ["4"]


def test_a_wait_that_takes_too_long_fails() -> None:
    program = "!g. +!g <- .wait({+b}, 500); no. -!g[error(E)] <- .print(E)."
    assert said(program) == ["0.6 wait_timeout"]
    assert said(program.replace("{+b}", "b(_)")) == said(program)


def test_with_a_third_argument_being_late_is_no_failure() -> None:
    assert said("!g. +!g <- .wait({+b}, 500, Ms); .print(Ms).") == ["0.6 500"]
    assert said("!g. +!g <- .wait(b, 500, Ms); .print(Ms).") == ["0.6 500"]
    assert said("b. !g. +!g <- .wait(b, 500, Ms); .print(Ms).") == ["0.2 0"]


def test_the_third_argument_tells_how_long_it_took() -> None:
    assert said("!g. +!g <- .wait({+b}, 5000, Ms); .print(Ms).", percepts={4: {"b"}}) == ["0.4 300"]


def test_a_formula_that_cannot_be_worked_out_fails() -> None:
    program = "!g. !s. +!g <- .wait(b(X) & .nth(X,[a],_)); no. -!g[error(E)] <- .print(E). +!s <- .wait(300); +b(9)."
    assert [line.split()[1] for line in said(program)] == ["wait_failed"]


def test_a_longest_time_that_is_no_number_is_refused() -> None:
    assert said("!g. +!g <- .wait({+b}, soon). -!g[error(E)] <- .print(E).")[0].endswith("wrong_arguments")


def test_a_wait_ends_while_suspended_and_its_plan_goes_on_when_resumed() -> None:
    program = "!g. !s. +!g <- .wait(500); .print(a). +!s <- .wait(100); .suspend(g); .wait(1000); .resume(g)."
    [line] = said(program)
    assert 1.2 < float(line.split()[0]) < 2


def test_a_wait_of_a_goal_that_is_dropped_leaves_nothing() -> None:
    for wait in (".wait(9000)", ".wait({+b})", ".wait(b(_), 9000)"):
        agent = Agent(parse_program(f"!g. !s. +!g <- {wait}. +!s <- .wait(200); .drop_intention(g)."))
        for cycle in range(10):
            agent.cycle(None, (), (), cycle / 10)
        assert (agent.idle, agent.timers, agent.waiters) == (True, [], []), wait


def test_two_plans_can_wait_for_the_same_event() -> None:
    program = "!a. !b. +!a <- .wait({+go(X)}); .print(a,X). +!b <- .wait({+go(X)}); .print(b,X)."
    assert sorted(line.split()[1] for line in said(program, percepts={5: {"go(1)"}})) == ["a1", "b1"]
