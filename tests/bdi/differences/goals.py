"""Goals, intentions, and what belongs around an agent."""

from bdi import Agent, Message, parse_program
from bdi.tools.trials.scripts import script_in
from tests.bdi.differences import happenings, shows


@shows("priorities")
def priorities() -> None:
    table = "priorities([safety]). priority(+bump, safety)."
    plans = "+bump <- stop. +a <- note."
    assert happenings(table + plans, [{"a", "bump"}]) == ["1 stop", "2 note"]
    assert happenings(plans, [{"a", "bump"}]) == ["1 note", "2 stop"]


@shows("soft-deadline")
def soft_deadline() -> None:
    program = "!g. +!g <- !h[soft_deadline(200)]; done. +!h <- .wait(500). ^!h[state(late)] <- late."
    assert [each.split()[1] for each in happenings(program)] == ["late", "done"]


@shows("deadline-rescue")
def deadline_rescue() -> None:
    program = "!g. +!g <- !h[hard_deadline(200)]; done. +!h <- long. -!h[error(E)] <- why(E); .wait(900); rescued."
    seen = [each.split(" ", 1)[1] for each in happenings(program)]
    assert seen == ["long", "why(deadline_reached)", "cancels 1", "rescued", "done"]


@shows("deadline-number")
def deadline_number() -> None:
    seen = happenings("!g. +!g <- !h[hard_deadline(soon)]; done. +!h <- a.")
    assert [each.split(" ", 1)[1] for each in seen] == ["given up +!h wrong_arguments", "a", "done"]


@shows("meta-of-meta")
def meta_of_meta() -> None:
    program = "!g. +!g <- a. +!note <- note. ^!G[state(achieved)] <- !note."
    assert [each.split()[1] for each in happenings(program, cycles=60)] == ["a", "note"]


@shows("finished")
def finished() -> None:
    program = "!g. +!g <- a; .fail. -!g <- b. ^!g[state(finished)[reason(R)]] <- end(R)."
    assert [each.split()[1] for each in happenings(program)][-1] == "end(unachieved)"


@shows("steps-ahead")
def steps_ahead() -> None:
    program = "!g. +!g <- !h(7); last. +!h(X) <- .current_intention(intention(_,[_,im(_,_,Body,U)])); ahead(Body,U)."
    assert happenings(program)[0].split(" ", 1)[1] == "ahead({last},[])"


@shows("suspended-reason")
def suspended_reason() -> None:
    program = "!g. +!g <- long. !look. +!look <- .wait(300); .findall(R, .suspended(g,R), L); saw(L)."
    assert happenings(program)[-1].endswith("saw([action(long)])")


@shows("suspended-atomic")
def suspended_atomic() -> None:
    program = "@p[atomic] +!g <- .suspend; resumed. !g. +!h <- .wait(300); .resume(g); others. !h."
    assert sorted(each.split()[1] for each in happenings(program)) == ["others", "resumed"]


@shows("drop-branch")
def drop_branch() -> None:
    program = (
        "!g. +!g <- (!a |&| !b); never. +!a <- long. +!b <- long. !stop. +!stop <- .wait(300); .drop_intention(a); ok."
    )
    seen = [each.split(" ", 1)[1] for each in happenings(program)]
    assert sorted(seen) == ["cancels 1", "cancels 2", "long", "long", "ok"]


@shows("failing-rescue")
def failing_rescue() -> None:
    assert happenings("!g. +!g <- .fail. -!g <- tried; .fail.") == ["2 tried", "3 given up +!g internal_action"]


@shows("fail-says")
def fail_says() -> None:
    program = '!g. +!g <- .fail(error_msg("no key")). -!g[error_msg(M),error(E)] <- why(M,E).'
    assert happenings(program) == ['2 why("no key",internal_action)']


@shows("last-alternative")
def last_alternative() -> None:
    assert happenings("!g. +!g <- (a; .fail) ||| .fail; no. -!g <- rescue.")[-1].endswith("rescue")


@shows("nested-branches")
def nested_branches() -> None:
    seen = [each.split()[1] for each in happenings("!g. +!g <- ((a; b) |&| c) ||| d; e.")]
    assert seen.count("e") == 1
    assert "b" not in seen


@shows("branch-values")
def branch_values() -> None:
    assert happenings("!g. +!g <- !f(X) |&| !h(Y); p(X,Y). +!f(1). +!h(2).")[-1].endswith("p(1,2)")


@shows("for-answers")
def for_answers() -> None:
    program = "b(1). b(2). b(3). !g. +!g <- for (b(X)) { p(X); -b(3) }."
    assert [each.split()[1] for each in happenings(program)] == ["p(1)", "p(2)", "p(3)"]


@shows("states-of-goals")
def states_of_goals() -> None:
    program = "!g. +!g <- !h. +!h <- .wait(200). ^!G[state(waiting)] <- waits(G)."
    assert [each.split()[1].partition("[")[0] for each in happenings(program)] == ["waits(h", "waits(g"]


@shows("code")
def code() -> None:
    assert happenings("!g. +!g <- 1 > 2. -!g[code(C)] <- p(C).")[-1].endswith('p("(1>2)")')


@shows("all-unifs")
def all_unifs() -> None:
    assert happenings("b(1). b(2). !g. @p[all_unifs] +!g : b(X) <- p(X).") == ["1 p(1)"]


@shows("breakpoint")
def breakpoint_of_plan() -> None:
    assert happenings("!g. @p[breakpoint] +!g <- a.") == ["1 a"]


@shows("classes")
def classes() -> None:
    agent = Agent(parse_program("+!g[source(S)] <- for_(S)."))
    agent.accepts = lambda message: message.sender != "mallory"
    agent.cycle(None, [Message("mallory", "achieve", "g"), Message("ann", "achieve", "g")])
    assert [str(action) for _ in range(3) for action in agent.cycle().actions] == ["for_(ann)"]


@shows("inspector")
def inspector() -> None:
    agent = Agent(parse_program("!g. +!g <- drive(1)."))
    agent.cycle()
    assert agent.why("g").waits_for == "drive(1)"


@shows("tests")
def tests_of_programs() -> None:
    script = script_in("!g. +!g <- a.\n/* prints\n1 a\n*/", "agent.asl")
    assert script
    assert [line.text for line in script.expectation.lines] == ["a"]
