"""Which event and which intention goes first, by the table that a program states."""

import pytest

from bdi import Agent, Finished, parse_program
from bdi.language.errors import WrongPriority

LEVELS = "priorities([safety, health, map, mission, navigation, movement]). "


def actions(program: str, *percepts: set[str], cycles: int = 30) -> list[str]:
    """The actions in order; each succeeds at once. After the last set of percepts nothing is new."""
    agent = Agent(parse_program(program))
    seen: list[str] = []
    finished: list[Finished] = []
    for cycle in range(cycles):
        outcome = agent.cycle(percepts[cycle] if cycle < len(percepts) else None, (), finished, cycle * 0.1)
        seen += map(str, outcome.actions)
        finished = [Finished(action.id) for action in outcome.actions]
    return seen


def test_the_most_urgent_event_goes_first_whatever_its_place_in_the_queue() -> None:
    program = """@walk[priority(movement)] +at(P) <- step(P).
        @care[priority(health)] +battery(low) <- dock.
        @stop[priority(safety)] +bumped <- halt."""
    sensed = {"at(uc)", "battery(low)", "bumped"}
    assert actions(LEVELS + program, sensed) == ["halt", "dock", "step(uc)"]
    assert actions(program, sensed) == ["step(uc)", "dock", "halt"]


def test_a_table_by_event_needs_no_labels() -> None:
    program = """+at(P) <- step(P). +battery(low) <- dock. -clear <- halt. +!go <- drive. !go."""
    table = "priority(-clear, safety). priority(+battery(low), health). priority({+!go}, mission). "
    assert actions(LEVELS + table + program, {"clear"}, {"at(uc)", "battery(low)"}) == [
        "drive",
        "halt",
        "dock",
        "step(uc)",
    ]


def test_the_first_entry_that_unifies_counts() -> None:
    table = "priority(+battery(full), movement). priority(+battery(_), health). "
    program = "+battery(full) <- undock. +battery(low) <- dock. @m[priority(map)] +door(D) <- note(D)."
    assert actions(LEVELS + table + program, {"battery(full)", "battery(low)", "door(1)"}) == [
        "dock",
        "note(1)",
        "undock",
    ]


def test_an_event_is_as_urgent_as_the_plan_that_would_be_chosen() -> None:
    program = """@empty[priority(safety)] +battery(B) : B < 5 <- stop.
        @fine[priority(movement)] +battery(B) <- show(B).
        @m[priority(mission)] +mail(M) <- collect(M)."""
    assert actions(LEVELS + program, {"battery(80)", "mail(1)"}) == ["collect(1)", "show(80)"]
    assert actions(LEVELS + program, {"battery(3)", "mail(1)"}) == ["stop", "collect(1)"]


def test_asking_which_plan_would_be_chosen_leaves_the_goal_as_it_was() -> None:
    program = """!find(X). @a[priority(safety)] +!find(1) : closed <- no.
        @b[priority(movement)] +!find(2) <- found(2)."""
    assert actions(LEVELS + program) == ["found(2)"]


def test_the_most_urgent_intention_takes_all_steps_and_the_others_go_on_while_it_waits() -> None:
    program = """!move. !rescue. @m[priority(movement)] +!move <- m1; m2; m3.
        @r[priority(safety)] +!rescue <- r1; r2; .wait(1000); r3."""
    assert actions(LEVELS + program) == ["r1", "r2", "m1", "m2", "m3", "r3"]


def test_a_sub_goal_is_as_urgent_as_the_goal_that_wants_it() -> None:
    program = """!move. !rescue. @m[priority(movement)] +!move <- m1; m2; m3; m4.
        @r[priority(safety)] +!rescue <- !lift; r2. @l +!lift <- !reach; l2. +!reach <- reach."""
    assert actions(LEVELS + program) == ["reach", "l2", "r2", "m1", "m2", "m3", "m4"]


def test_a_goal_apart_has_its_own_level() -> None:
    program = """!rescue. @m[priority(movement)] +!move <- m1.
        @r[priority(safety)] +!rescue <- !!move; .wait(1000); r2; r3."""
    assert actions(LEVELS + program) == ["m1", "r2", "r3"]
    assert actions(LEVELS + program.replace(".wait(1000)", "r1")) == ["r1", "r2", "r3", "m1"]


def test_the_plan_for_a_failure_is_as_urgent_as_the_plan_that_failed() -> None:
    program = """!move. !rescue. @m[priority(movement)] +!move <- m1; m2; m3; m4.
        @r[priority(safety)] +!rescue <- .fail. -!rescue <- call; wait_for_help."""
    assert actions(LEVELS + program) == ["call", "wait_for_help", "m1", "m2", "m3", "m4"]


def test_tail_recursion_does_not_forget_what_is_urgent() -> None:
    program = """n(0). !move. !rescue. @m[priority(movement)] +!move <- m1; m2; m3; m4.
        @r[priority(safety)] +!rescue : n(0) <- ++n(1); --n(0); r1; !rescue. +!rescue <- r2; r3."""
    assert actions(LEVELS + program) == ["r1", "r2", "r3", "m1", "m2", "m3", "m4"]


def test_branches_keep_the_level_of_their_plan() -> None:
    program = """!move. !rescue. @m[priority(movement)] +!move <- m1; m2; m3.
        @r[priority(safety)] +!rescue <- (a1; a2) |&| (b1; b2); r."""
    assert actions(LEVELS + program) == ["a1", "b1", "a2", "b2", "r", "m1", "m2", "m3"]


def test_within_a_level_intentions_take_turns() -> None:
    program = "!a. !b. @a[priority(map)] +!a <- a1; a2; a3. @b[priority(map)] +!b <- b1; b2; b3."
    assert actions(LEVELS + program) == actions(program) == ["a1", "b1", "a2", "b2", "a3", "b3"]


def test_what_has_no_level_comes_last_or_where_the_table_says_default() -> None:
    program = "!a. !b. @a[priority(low)] +!a <- a1; a2; a3. +!b <- b1; b2; b3."
    assert actions("priorities([high, low]). " + program) == ["a1", "a2", "a3", "b1", "b2", "b3"]
    assert actions("priorities([high, default, low]). " + program) == ["b1", "b2", "b3", "a1", "a2", "a3"]


def test_a_plan_without_level_leaves_its_intention_as_urgent_as_it_was() -> None:
    program = "!a. !b. @a[priority(low)] +!a <- !sub; a2. +!sub <- s1; s2. +!b <- b1; b2; b3."
    assert actions("priorities([high, default, low]). " + program) == ["b1", "b2", "b3", "s1", "s2", "a2"]


def test_an_atomic_plan_goes_before_everything() -> None:
    program = """@m[atomic, priority(movement)] +at(P) <- m1; m2; m3. @s[priority(safety)] +bumped <- halt."""
    assert actions(LEVELS + program, {"at(a)"}, {"at(a)", "bumped"}) == ["m1", "m2", "m3", "halt"]


def test_a_level_without_end_leaves_no_turn_to_those_below() -> None:
    program = """!spin. !move. @m[priority(movement)] +!move <- m1; m2.
        @s[priority(safety)] +!spin <- .random(_); !spin."""
    assert actions(LEVELS + program, cycles=100) == []


def test_without_a_table_priorities_of_labels_mean_nothing() -> None:
    program = "!a. !b. @a[priority(9)] +!a <- a1; a2. @b[priority(1)] +!b <- b1; b2."
    assert actions(program) == actions(program.replace("[priority(9)]", "").replace("[priority(1)]", ""))


def test_plans_are_chosen_in_source_order_whatever_their_level() -> None:
    program = "!a. @slow[priority(movement)] +!a <- slow. @fast[priority(safety)] +!a <- fast."
    assert actions(LEVELS + program) == ["slow"]


def test_the_table_can_be_asked_like_any_belief() -> None:
    assert actions(LEVELS + "!g. +!g : priorities([First|_]) <- say(First).") == ["say(safety)"]


@pytest.mark.parametrize(
    ("program", "problem"),
    [
        ("priorities(safety).", "1:1: a table of priorities is a list of different names"),
        ("priorities([a,b,a]).", "1:1: a table of priorities is a list of different names"),
        ("priorities([a]).\npriorities([b]).", "2:1: the table of priorities is stated twice"),
        ("priorities([a]).\npriority(+b, c).", "2:1: c is no level of the table; expected a"),
        ("priorities([a]). priority(b, a).", r"1:18: b is no event; expected \+b\(_\), -b\(_\) or"),
        ("priorities([a,b]).\n@l[priority(urgent)] +!g.", "2:1: urgent is no level of the table; expected a or b"),
        ("priorities([a,b]).\n+!h. {\n@l[priority(c)] +!g. }", "3:1: c is no level of the table"),
    ],
)
def test_a_wrong_table_is_refused_with_its_place(program: str, problem: str) -> None:
    with pytest.raises(WrongPriority, match=problem):
        Agent(parse_program(program))
