"""Sub-plans: what is there only while the plan that they stand behind is being carried out."""

from bdi import Action, Agent, Finished, TraceEntry, parse_program
from bdi.debug.trace import Deliberated


class Run:
    """An agent whose actions stay under way until they are named."""

    def __init__(self, program: str) -> None:
        self.agent = Agent(parse_program(program))
        self.said: list[str] = []
        self.under_way: dict[str, Action] = {}
        self.cancelled: list[str] = []
        self._cycle = 0

    def cycles(self, count: int, *percepts: str, done: str | None = None, failed: str | None = None) -> "Run":
        """Return the outputs of some cycles; the named actions end in the first of them."""
        for _ in range(count):
            self._cycle += 1
            finished = [Finished(self.under_way.pop(name).id) for name in (done,) if name]
            finished += [Finished(self.under_way.pop(name).id, "jammed") for name in (failed,) if name]
            done = failed = None
            outcome = self.agent.cycle(percepts, (), finished, self._cycle / 10)
            self.said += outcome.printed
            names = {action.id: name for name, action in self.under_way.items()}
            self.cancelled += [names[number] for number in outcome.cancelled]
            self.under_way |= {str(action.term): action for action in outcome.actions}
        return self


PATROL = "!patrol(hall). +!patrol(R) <- walk(R). "


def test_a_sub_plan_reacts_to_a_percept_while_its_goal_is_pursued() -> None:
    run = Run(PATROL + "{ +noise(P) <- look(P). }").cycles(3)
    assert list(run.under_way) == ["walk(hall)"]
    run.cycles(4, "noise(left)")
    assert list(run.under_way) == ["walk(hall)", "look(left)"]


def test_no_plan_reacts_once_the_goal_is_reached() -> None:
    run = Run(PATROL + "{ +noise(P) <- look(P). }").cycles(3).cycles(3, done="walk(hall)").cycles(4, "noise(left)")
    assert not run.under_way
    assert not run.agent.intentions


def test_a_reaction_is_an_event_more_and_the_plans_of_the_program_have_theirs() -> None:
    program = PATROL + "{ +noise(P) <- look(P). } +noise(P) <- .print(heard)."
    run = Run(program).cycles(3).cycles(1, "noise(left)")
    assert run.said == ["heard"]
    assert list(run.under_way) == ["walk(hall)"]
    run.cycles(1, "noise(left)")
    assert list(run.under_way) == ["walk(hall)", "look(left)"]


def test_what_vanishes_and_what_the_agent_notes_by_itself_are_reacted_to_as_well() -> None:
    run = Run(PATROL + "{ -light <- lamp. +tired <- rest. } !t. +!t <- .wait(800); ++tired.").cycles(4, "light")
    assert list(run.under_way) == ["walk(hall)"]
    run.cycles(9)
    assert list(run.under_way) == ["walk(hall)", "lamp", "rest"]


def test_a_reaction_knows_the_variables_of_the_plan_around_it() -> None:
    program = "room(2). !patrol. +!patrol : room(N) <- M = N*10; walk. { +noise(P) : N > 1 <- look(P,N,M). }"
    assert "look(left,2,20)" in Run(program).cycles(4).cycles(4, "noise(left)").under_way


def test_a_sub_plan_for_a_goal_knows_them_too() -> None:
    program = "!visit(post3). +!visit(P) <- !find(7); done. { +!find(N) : N > 5 <- ask(P,N). }"
    assert list(Run(program).cycles(4).under_way) == ["ask(post3,7)"]


def test_the_variables_of_all_plans_around_are_known() -> None:
    program = "!a(1). +!a(X) <- !b(2). { +!b(Y) <- !c(3). { +!c(Z) <- act(X,Y,Z). } }"
    assert list(Run(program).cycles(6).under_way) == ["act(1,2,3)"]


def test_a_head_with_a_variable_from_around_is_about_its_value() -> None:
    program = PATROL + "{ +noise(R) <- look(R). }"
    assert "look(attic)" not in Run(program).cycles(3).cycles(4, "noise(attic)").under_way
    assert "look(hall)" in Run(program).cycles(3).cycles(4, "noise(hall)").under_way


def test_what_a_sub_plan_finds_out_stays_its_own() -> None:
    program = "!g. +!g <- .wait(700); if (.ground(X)) { bound(X) } else { free }. { +noise(P) <- X = P; look(X). }"
    assert list(Run(program).cycles(3).cycles(9, "noise(left)").under_way) == ["look(left)", "free"]


def test_a_sub_plan_answers_the_goal_with_its_own_variables() -> None:
    program = "!g(4). +!g(X) <- !double(Y); act(Y). { +!double(Z) <- Z = X*2. }"
    assert list(Run(program).cycles(5).under_way) == ["act(8)"]


def test_the_innermost_sub_plan_goes_first_and_its_context_must_hold() -> None:
    program = """loud. !a.
        +!a <- !b. { +noise <- outer. }
        +!b <- walk. { +noise : not loud <- inner. +noise : loud <- innermost. }"""
    assert list(Run(program).cycles(5).cycles(4, "noise").under_way) == ["walk", "innermost"]
    program = program.replace("loud. !a", "!a").replace(": not loud", ": quiet")
    assert list(Run(program).cycles(5).cycles(4, "noise").under_way) == ["walk", "outer"]


def test_every_intention_reacts_for_itself() -> None:
    program = "!p(1). !p(2). +!p(N) <- walk(N). { +noise <- look(N). }"
    assert sorted(Run(program).cycles(5).cycles(6, "noise").under_way) == ["look(1)", "look(2)", "walk(1)", "walk(2)"]


def test_the_branches_of_one_plan_react_once() -> None:
    program = "!p. +!p <- (a |&| b). { +noise <- look. }"
    run = Run(program).cycles(6).cycles(6, "noise")
    assert sorted(run.under_way) == ["a", "b", "look"]
    assert len(run.agent.intentions) == 3


def test_a_reaction_ends_with_the_goal_it_belongs_to() -> None:
    program = PATROL + "{ +noise(P) <- look(P); .print(seen). }"
    run = Run(program).cycles(3).cycles(3, "noise(left)")
    run.cycles(3, "noise(left)", done="walk(hall)")
    assert run.cancelled == ["look(left)"]
    assert not run.said
    assert not run.agent.intentions


def test_a_reaction_ends_when_its_goal_is_dropped_or_fails() -> None:
    program = "!q. " + PATROL + "{ +noise(P) <- look(P). } +!q <- stop; .drop_intention(patrol(_))."
    run = Run(program).cycles(5).cycles(4, "noise(left)").cycles(4, "noise(left)", done="stop")
    assert sorted(run.cancelled) == ["look(left)", "walk(hall)"]
    run = Run(PATROL + "{ +noise(P) <- look(P). }").cycles(3).cycles(3, "noise(left)")
    run.cycles(3, "noise(left)", failed="walk(hall)")
    assert run.cancelled == ["look(left)"]


def test_a_reaction_that_forks_ends_with_its_goal() -> None:
    run = Run(PATROL + "{ +noise(P) <- (look(P) |&| listen(P)). }").cycles(3).cycles(5, "noise(left)")
    assert sorted(run.under_way) == ["listen(left)", "look(left)", "walk(hall)"]
    run.cycles(3, done="walk(hall)")
    assert sorted(run.cancelled) == ["listen(left)", "look(left)"]


def test_a_reaction_whose_turn_comes_after_its_goal_is_over_does_nothing() -> None:
    program = "!g. +!g <- walk. { +noise <- look. } +noise <- .drop_intention(g)."
    run = Run(program).cycles(3).cycles(6, "noise")
    assert list(run.under_way) == ["walk"]
    assert run.cancelled == ["walk"]


def test_a_goal_can_be_ended_by_its_own_reaction() -> None:
    run = Run("!g. +!g <- !h; after. +!h <- walk. { +enough <- .succeed_goal(h). }").cycles(4).cycles(5, "enough")
    assert run.cancelled == ["walk"]
    assert list(run.under_way) == ["walk", "after"]


def test_a_reaction_can_pursue_the_goals_of_its_sub_plans() -> None:
    program = PATROL + "{ +noise(P) <- !look(P). +!look(P) <- turn(P,R). } +!look(P) <- wrong."
    assert "turn(left,hall)" in Run(program).cycles(3).cycles(6, "noise(left)").under_way


def test_a_suspended_goal_does_not_react() -> None:
    program = "!s. !g. +!g <- walk. { +noise <- look. } +!s <- .wait(300); .suspend(g)."
    run = Run(program).cycles(8).cycles(5, "noise")
    assert list(run.under_way) == ["walk"]


def test_the_failure_of_a_goal_is_taken_care_of_by_a_sub_plan() -> None:
    run = Run("!g(1). +!g(X) <- !h; after(X). { -!h <- mend(X). } +!h <- try.").cycles(4).cycles(3, failed="try")
    assert list(run.under_way) == ["mend(1)"]
    run = Run("!g(1). +!g(X) <- !h; after(X). { -!h[error(no_relevant)] <- mend(X). } -!h <- wrong.").cycles(6)
    assert list(run.under_way) == ["mend(1)"]
    assert list(run.cycles(3, done="mend(1)").under_way) == ["after(1)"]


def test_a_question_is_answered_by_a_sub_plan() -> None:
    program = "!g(1). +!g(X) <- ?where(P); go(P). { +?where(P) <- P = room(X). }"
    assert list(Run(program).cycles(6).under_way) == ["go(room(1))"]
    outside = "!g. +!g <- !h. { +?where(P) <- P = here. } +!h <- ?where(P); go(P). !k. +!k <- ?where(P). -!k <- lost."
    assert sorted(Run(outside).cycles(9).under_way) == ["go(here)", "lost"]


def test_a_plan_with_sub_plans_can_come_later() -> None:
    run = Run("").cycles(1)
    run.agent.add_plan(parse_program("+go <- walk. { +noise <- look. }").plans[0])
    assert list(run.cycles(3, "go").cycles(4, "go", "noise").under_way) == ["walk", "look"]


def test_reactions_obey_the_table_of_priorities() -> None:
    program = "{table} !g. +!g <- walk. {{ +alarm <- look. +bumped <- halt. }}"
    table = "priorities([safety,rest]). priority(+bumped,safety)."
    run = Run(program.format(table="")).cycles(4).cycles(6, "alarm", "bumped")
    assert list(run.under_way) == ["walk", "look", "halt"]
    run = Run(program.format(table=table)).cycles(4).cycles(6, "alarm", "bumped")
    assert list(run.under_way) == ["walk", "halt", "look"]


def test_a_reaction_is_as_urgent_as_the_goal_it_belongs_to() -> None:
    program = """priorities([high,low]). !busy(1). !urgent.
        @low[priority(low)] +!busy(N) <- .print(N); !busy(N+1).
        {label} +!urgent <- walk. {{ +noise <- look. }}"""
    for label, reacts in (("@high[priority(high)]", True), ("", False)):
        run = Run(program.format(label=label)).cycles(9).cycles(9, "noise")
        assert ("look" in run.under_way) is reacts


def test_a_goal_that_is_pursued_again_is_a_new_one() -> None:
    run = Run("!g(0). +!g(N) <- walk(N); !g(N+1). { +noise <- look(N). }").cycles(2).cycles(4, "noise")
    assert list(run.under_way) == ["walk(0)", "look(0)"]
    run.cycles(4, "noise", done="walk(0)")
    assert run.cancelled == ["look(0)"]
    assert list(run.cycles(1).cycles(4, "noise").under_way) == ["look(0)", "walk(1)", "look(1)"]


def test_a_long_patrol_with_reactions_does_not_grow() -> None:
    program = """!p(0). +!p(N) <- !walk(N,M); !p(M).
        { +!walk(X,Y) <- .wait(100); Y = X+1.
          +noise <- .print(heard); look. -noise <- !calm. +!calm <- .print(quiet). }"""
    run = Run(program)
    for _ in range(150):
        run.cycles(6, "noise").cycles(4)
    assert run.said.count("heard") > 50
    assert len(run.agent.intentions) <= 4
    assert len(run.agent.events) <= 4
    assert max(len(each.stack) for each in run.agent.intentions.values()) <= 3


def test_the_trace_says_why_a_sub_plan_applies_with_the_values_around_it() -> None:
    program = "!g(1). +!g(X) <- !h. { +!h : X > 5 <- far. +!h : X < 5 <- near. }"
    agent = Agent(parse_program(program))
    told: list[str] = []

    def listen(entry: TraceEntry) -> None:
        if isinstance(entry, Deliberated):
            told.extend(verdict.why for verdict in entry.verdicts)

    agent.listen(listen, explain=True)
    for _ in range(3):
        agent.cycle()
    assert told == ["the first that applies", "1>5 is false", "the first that applies"]


def test_where_no_sub_plan_applies_the_plans_around_and_those_of_the_program_have_their_turn() -> None:
    program = """!g(2). +!g(N) <- !a(1); !a(5); !b; .print(end).
        { +!a(X) : X < N <- .print(low,X). +!b : N > 2 <- .print(no). }
        +!a(X) <- .print(high,X). +!b <- .print(b)."""
    assert Run(program).cycles(12).said == ["low1", "high5", "b", "end"]


def test_what_a_plan_notes_itself_is_for_its_sub_plans_first_and_it_waits_for_them() -> None:
    program = """!g(2). +!g(N) <- +seen(1); +seen(5); .print(end).
        { +seen(X) : X < N <- .print(mine,X). }
        +seen(X) <- .print(everybodys,X)."""
    assert Run(program).cycles(12).said == ["mine1", "everybodys5", "end"]


def test_a_reaction_can_say_that_the_plan_around_it_is_done() -> None:
    program = """+offer(X) <: false <- .print(considered,X). { +taken(Y) <- .print(mine,X,Y); .done; .print(never). }
        +!no <- .print(never)."""
    run = Run(program).cycles(4, "offer(7)")
    assert len(run.agent.intentions) == 1
    run.cycles(4, "offer(7)", "taken(now)")
    assert run.said == ["considered7", "mine7now"]
    assert not run.agent.intentions
    run.cycles(2, "offer(7)").cycles(3, "offer(7)", "taken(again)")
    assert run.said == ["considered7", "mine7now"]
