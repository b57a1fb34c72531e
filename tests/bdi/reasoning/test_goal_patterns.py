"""Goals by pattern: what each pattern promises, seen in the actions of a program while the world changes."""

from collections.abc import Iterable

import pytest

from bdi import Agent, AgentSpeakSyntaxError, Finished, parse_program


class World:
    """A body whose actions succeed at once, but for those that fail; what is perceived can be changed."""

    def __init__(self, program: str, *, fails: Iterable[str] = (), sees: Iterable[str] = ()) -> None:
        self.agent = Agent(parse_program(program))
        self.fails = set(fails)
        self.sees = set(sees)
        self.actions: list[str] = []
        self.given_up: list[str] = []
        self._ended: list[Finished] = []

    def run(self, cycles: int) -> list[str]:
        """The actions of so many cycles."""
        before = len(self.actions)
        for _ in range(cycles):
            outcome = self.agent.cycle(self.sees, [], self._ended)
            self._ended = [Finished(each.id, "broken" if str(each) in self.fails else None) for each in outcome.actions]
            self.actions += map(str, outcome.actions)
            self.given_up += [failure.goal for failure in outcome.failures]
        return self.actions[before:]


def block(pattern: str, plans: str, around: str = "") -> str:
    return f"!start. +!start <- !at(dock); there. -!start <- given_up. {{begin {pattern}}} {plans} {{end}} {around}"


TWO = "+!at(P) : road(P) <- drive(P). +!at(P) <- walk(P)."


def test_dg_a_goal_that_is_believed_is_reached_without_a_plan() -> None:
    world = World(block("dg(at(dock))", TWO), sees=["at(dock)"])
    assert world.run(10) == ["there"]


def test_dg_a_plan_that_ends_without_its_goal_has_failed() -> None:
    world = World(block("dg(at(dock))", TWO))
    assert world.run(10) == ["walk(dock)", "given_up"]


def test_dg_a_goal_reached_by_other_means_ends_its_plan() -> None:
    world = World(block("dg(at(dock))", "+!at(P) <- walk(P); wave; wave; wave."))
    assert world.run(3) == ["walk(dock)", "wave"]
    world.sees = {"at(dock)"}
    assert world.run(10) == ["there"]


def test_bdg_tries_again_as_long_as_a_plan_is_applicable() -> None:
    world = World(block("bdg(at(dock))", "+!at(P) : road(P) <- drive(P)."), sees=["road(dock)"])
    assert set(world.run(30)) == {"drive(dock)"}
    assert len(world.actions) > 3
    world.sees = set()
    assert world.run(20)[-1] == "given_up"
    assert world.run(10) == []


def test_bdg_takes_another_plan_once_the_first_no_longer_applies() -> None:
    world = World(block("bdg(at(dock))", TWO), sees=["road(dock)"])
    world.run(6)
    world.sees = set()
    world.run(6)
    world.sees = {"at(dock)"}
    world.run(10)
    assert list(dict.fromkeys(world.actions)) == ["drive(dock)", "walk(dock)", "there"]


def test_ebdg_tries_each_plan_once_and_then_fails() -> None:
    plans = "+!at(P) <- drive(P). +!at(P) <- swim(P). +!at(P) : boat <- row(P). +!at(P) <- walk(P)."
    world = World(block("ebdg(at(dock))", plans), fails=["swim(dock)"])
    assert world.run(60) == ["drive(dock)", "swim(dock)", "walk(dock)", "given_up"]


def test_ebdg_starts_afresh_when_the_goal_comes_up_again() -> None:
    again = "+again <- !start."
    world = World(block("ebdg(at(dock))", "+!at(P) <- drive(P). +!at(P) <- walk(P).", again))
    world.run(40)
    world.sees = {"again"}
    assert world.run(40) == ["drive(dock)", "walk(dock)", "given_up"]


def test_ebdg_stops_trying_once_the_goal_is_believed() -> None:
    world = World(block("ebdg(at(dock))", "+!at(P) <- drive(P). +!at(P) <- walk(P); +at(P). +!at(P) <- swim(P)."))
    assert world.run(40) == ["drive(dock)", "walk(dock)", "there"]


def test_bc_never_gives_up_even_without_an_applicable_plan() -> None:
    world = World(block("bc(at(dock))", "+!at(P) : road(P) <- drive(P)."))
    assert world.run(50) == []
    world.sees = {"road(dock)"}
    assert set(world.run(20)) == {"drive(dock)"}
    world.sees = {"at(dock)"}
    assert world.run(20)[-1] == "there"


def test_bc_of_ebdg_goes_through_all_plans_round_and_round() -> None:
    world = World(block("bc(at(dock),ebdg)", "+!at(P) <- drive(P). +!at(P) <- walk(P)."))
    assert world.run(60)[:5] == ["drive(dock)", "walk(dock)", "drive(dock)", "walk(dock)", "drive(dock)"]


def test_a_blind_agent_does_not_grow() -> None:
    world = World(block("bc(at(dock))", "+!at(P) <- drive(P)."))
    world.run(1000)
    (intention,) = world.agent.intentions.values()
    assert len(intention.stack) < 5


def test_smc_is_blind_until_the_goal_is_hopeless() -> None:
    world = World(block("smc(at(dock),stairs)", "+!at(P) <- drive(P)."))
    assert set(world.run(30)) == {"drive(dock)"}
    world.sees = {"stairs"}
    assert world.run(20)[-1] == "given_up"
    assert world.run(10) == []


def test_rc_drops_a_goal_whose_motive_is_gone() -> None:
    world = World(block("rc(at(dock),mail)", "+!at(P) <- drive(P)."), sees=["mail"])
    assert set(world.run(30)) == {"drive(dock)"}
    world.sees = set()
    assert world.run(20)[-1] == "there"
    assert world.run(10) == []


@pytest.mark.parametrize(
    ("sees", "last"), [({"mail", "stairs"}, "given_up"), (set(), "there"), ({"mail", "at(dock)"}, "there")]
)
def test_omc_ends_by_hopelessness_by_a_lost_motive_or_by_success(sees: set[str], last: str) -> None:
    world = World(block("omc(at(dock),stairs,mail)", "+!at(P) <- drive(P)."), sees=["mail"])
    assert set(world.run(30)) == {"drive(dock)"}
    world.sees = sees
    assert world.run(20)[-1] == last
    assert world.run(10) == []


def test_mg_is_pursued_at_the_start_and_whenever_it_is_lost() -> None:
    world = World("{begin mg(charged)} +!charged <- charge. {end}", sees=["charged"])
    assert world.run(10) == []
    for _ in range(2):
        world.sees = set()
        assert set(world.run(10)) == {"charge"}
        world.sees = {"charged"}
        world.run(4)
        assert world.run(10) == []


def test_mg_by_another_pattern_gives_up_as_that_one_does() -> None:
    world = World("{begin mg(charged,ebdg)} +!charged <- charge. +!charged <- call_help. {end}")
    assert world.run(40) == ["charge", "call_help"]
    assert [goal.lstrip("+-!") for goal in world.given_up] == ["charged"]


SEQUENCE = """
{begin sga("+mail(P)", "not closed(P)", deliver(P))} {end}
+!deliver(P) <- fetch(P); hand_over(P).
"""


def test_sga_adopts_one_goal_at_a_time_in_the_order_in_which_they_came() -> None:
    world = World(SEQUENCE)
    world.sees = {"mail(a)"}
    world.run(2)
    world.sees |= {"mail(b)"}
    world.run(1)
    world.sees |= {"mail(c)", "closed(d)"}
    world.run(1)
    world.sees |= {"mail(d)"}
    world.run(40)
    assert world.actions == [f"{deed}({post})" for post in "abc" for deed in ("fetch", "hand_over")]


def test_sga_goes_on_with_the_next_goal_after_a_failure() -> None:
    world = World(SEQUENCE, fails=["fetch(a)"], sees=["mail(a)", "mail(b)"])
    assert world.run(40) == ["fetch(a)", "fetch(b)", "hand_over(b)"]


def test_a_pattern_keeps_to_its_namespace() -> None:
    plans = "{begin ebdg(at(P))} +!at(P) <- drive(P). +!at(P) <- walk(P); +at(P). {end}"
    text = f"!a::at(dock). {{begin namespace(a)}} {plans} {{end}} +!at(P) <- swim(P). +at(P) <- shout."
    world = World(text)
    assert world.run(40) == ["drive(dock)", "walk(dock)"]
    assert world.agent.ask("a::at(P)")
    assert not world.agent.ask("tried__plan(N,G)") and not world.agent.ask("a::tried__plan(N,G)")


def test_plans_of_a_pattern_read_as_what_they_are_and_stand_where_the_directive_does() -> None:
    program = parse_program("b.\n  { begin dg(g(X)) }\n+!g(X) : c(X) <- a(X).\n+!h <- d.\n{ end }")
    assert [str(plan) for plan in program.plans] == [
        "@p__1 +!h <- d.",
        "@p__2 +!g(X) : g(X).",
        "@p__3 +!g(X) : c(X) <- a(X); ?g(X).",
        "@p__4 +g(X) <- .succeed_goal(g(X)).",
    ]
    assert [plan.place.line for plan in program.plans] == [4, 2, 3, 2]


@pytest.mark.parametrize(
    ("directive", "expected"),
    [
        ("dg", r"dg\(goal\)"),
        ("bdg(g,h)", r"bdg\(goal\)"),
        ("bc(g,smc)", "bc"),
        ("smc(g)", r"smc\(goal,failure\)"),
        ("omc(g,f)", r"omc\(goal,failure,motive\)"),
        ('sga("+g", ")", h)', "sga"),
        ('sga("g", "true", h)', "sga"),
    ],
)
def test_a_pattern_with_wrong_arguments_is_refused_in_place(directive: str, expected: str) -> None:
    with pytest.raises(AgentSpeakSyntaxError, match=rf"<text>:2:1: .*wrong arguments; expected .*{expected}"):
        parse_program(f"b.\n{{ begin {directive} }} +!g <- a. {{ end }}")
