"""Namespaces and modules: who can name what."""

from collections.abc import Mapping
from pathlib import Path

import pytest

from bdi import Agent, AgentSpeakSyntaxError, Finished, Includes, Message, NotALiteral, parse_program, parse_term
from bdi.language.parser.includes import Read


def reader(files: Mapping[str, str]) -> Read:
    def read(path: Path) -> str:
        try:
            return files[path.as_posix()]
        except KeyError:
            raise FileNotFoundError(path) from None

    return read


def deeds(text: str, cycles: int = 40, **files: str) -> list[str]:
    """Return what is done and printed; the files are modules with the ending .asl."""
    read = reader({f"{name}.asl": content for name, content in files.items()})
    return done_by(Agent(parse_program(text, read=read), includes=Includes(read)), cycles)


def done_by(agent: Agent, cycles: int = 40) -> list[str]:
    seen: list[str] = []
    ended: list[Finished] = []
    for _ in range(cycles):
        outcome = agent.cycle(None, [], ended)
        ended = [Finished(action.id) for action in outcome.actions]
        seen += [*map(str, outcome.actions), *outcome.printed, *[failure.message for failure in outcome.failures]]
    return seen


COUNTER = "count(0). +!up <- ?count(N); -+count(N+1)."


# ---- modules -------------------------------------------------------------------------------------------------------


def test_the_same_file_in_two_namespaces_is_two_modules() -> None:
    text = """{include("counter.asl", one)} {include("counter.asl", two)} !go.
        +!go <- !one::up; !one::up; !two::up; ?one::count(A); ?two::count(B); show(A,B)."""
    assert deeds(text, counter=COUNTER) == ["show(2,1)"]


def test_without_a_namespace_a_file_is_included_where_it_stands() -> None:
    assert deeds('{include("counter.asl")} !up. +count(N) <- show(N).', counter=COUNTER) == ["show(0)", "show(1)"]
    inside = '{begin namespace(a)} {include("counter.asl")} {end} !a::up. +a::count(N) <- show(N). +count(N) <- wrong.'
    assert deeds(inside, counter=COUNTER) == ["show(0)", "show(1)"]


def test_a_variable_as_namespace_makes_a_fresh_one_each_time() -> None:
    text = '{include("counter.asl", X)} {include("counter.asl", _)} +NS::count(N) : NS \\== default <- show(N).'
    assert deeds(text, counter=COUNTER) == ["show(0)", "show(0)"]


def test_beliefs_goals_and_plans_of_a_module_are_no_others() -> None:
    text = """{begin namespace(a)} b(1). !g. +!g : b(X) <- show(X). +b(X) <- react(X). {end}
        b(2). !g. +!g : b(X) <- outside(X). +b(X) <- react_outside(X)."""
    assert sorted(deeds(text)) == ["outside(2)", "react(1)", "react_outside(2)", "show(1)"]


def test_what_is_inside_a_term_belongs_to_no_namespace_unless_it_says_so() -> None:
    text = """{begin namespace(a)} b(x, f(y), [z], ::x, ::f(y), default::z)[seen(w)]. !g.
        +!g <- ?b(A,B,C,D,E,F); show(A,B,C,D,E,F); ?b(x,f(y),[z],_,_,z)[seen(w)];
            .print(x, " ", ::x, " ", this_ns). {end}"""
    assert deeds(text) == ["show(x,f(y),[z],a::x,a::f(y),z)", "x a::x a"]


def test_a_formula_given_to_an_internal_action_has_to_name_its_namespace() -> None:
    text = """{begin namespace(a)} b(1). b(2). !g.
        +!g <- .findall(X, b(X), L); .findall(X, ::b(X), M); .count(a::b(_), N); show(L,M,N). {end}"""
    assert deeds(text) == ["show([],[1,2],2)"]


def test_actions_and_comparisons_are_not_of_the_module() -> None:
    text = """{begin namespace(a)} colour(red). !g.
        +!g : colour(C) & C == red & C \\== ::red <- paint(red); !h("x"). +!h(S) <- say(S). {end}"""
    assert deeds(text) == ["paint(red)", 'say("x")']


def test_a_module_reaches_the_outside_by_default() -> None:
    text = "{begin namespace(a)} !g. +!g <- !default::h; ?default::b(X); show(X). {end} +!h <- +b(7)."
    assert deeds(text) == ["show(7)"]


def test_rules_signs_of_negation_and_conditions_are_of_the_module() -> None:
    text = """{begin namespace(a)}
        p(1). p(2). ~q(1). good(X) :- p(X) & not ~q(X) & not default::bad(X). !g.
        +!g <- if (good(2)) { yes }; for (p(X)) { each(X) }; ?~q(Y); show(Y). {end} q(2). ~q(2)."""
    assert deeds(text) == ["yes", "each(1)", "each(2)", "show(1)"]


def test_a_plan_as_a_value_is_of_the_module_in_which_it_is_written() -> None:
    text = "{begin namespace(a)} !g. +!g <- B = {!h; ?b(X); show(X)}; B. +!h <- +b(3). {end} +!h <- wrong."
    assert deeds(text) == ["show(3)"]


def test_a_plan_for_any_goal_takes_those_of_its_module() -> None:
    text = "{begin namespace(a)} !g. +!G <- any(G). {end} !h. +!h <- h."
    assert sorted(deeds(text)) == ["any(g[source(self)])", "h"]


def test_labels_are_of_the_module_too() -> None:
    text = "{begin namespace(a)} @p +!g <- a. {end} @p +!g <- b. !go. +!go <- .remove_plan(a::p); !g; !a::g."
    seen = deeds(text)
    assert seen[0] == "b" and "there is no plan for +!a::g" in seen[1]


# ---- local namespaces ----------------------------------------------------------------------------------------------

VAULT = """{namespace(priv,local)}
priv::secret(42).
+?told(S) <- ?priv::secret(S).
{begin namespace(priv)} +!open : secret(S) <- show(S). {end}
+!open <- !priv::open."""


def test_a_local_namespace_is_used_by_its_own_file_only() -> None:
    text = '{include("vault.asl",a)} !go. +!go <- ?a::told(S); show(S); !a::open; ?priv::secret(_).'
    assert deeds(text, vault=VAULT)[:2] == ["show(42)", "show(42)"]
    assert "?priv::secret(_) is not the case" in deeds(text, vault=VAULT)[2]


def test_two_modules_with_a_local_namespace_of_one_name_do_not_meet() -> None:
    other = "{begin namespace(priv,local)} secret(1). {end} +?told(S) <- .findall(X, priv::secret(X), S)."
    text = '{include("vault.asl",a)} {include("other.asl",b)} !go. +!go <- ?a::told(S); ?b::told(T); show(S,T).'
    assert deeds(text, vault=VAULT, other=other) == ["show(42,[1])"]


def test_a_local_namespace_is_not_found_by_a_variable_or_from_outside() -> None:
    text = (
        '{include("vault.asl",a)} !go. +!go <- .findall(N, .namespace(N), L); .findall(N, N::secret(_), M); show(L,M).'
    )
    read = reader({"vault.asl": VAULT})
    agent = Agent(parse_program(text, read=read))
    assert done_by(agent) == ["show([default],[])"]
    assert agent.ask("priv::secret(X)") == [] and agent.ask("NS::secret(X)") == []
    with pytest.raises(AgentSpeakSyntaxError):
        agent.ask("#1priv::secret(X)")


def test_a_module_can_hand_out_its_own_local_namespace() -> None:
    text = """{begin namespace(a,local)} b(5). !g. +!g <- !default::h(this_ns). {end}
        +!h(NS) <- ?NS::b(X); show(X)."""
    assert deeds(text) == ["show(5)"]


# ---- namespaces as variables ---------------------------------------------------------------------------------------


def test_a_question_with_a_variable_namespace_is_asked_in_each() -> None:
    text = "a::p(1). b::p(2). p(3). a::q(4). !go. +!go <- .setof(N-X, N::p(X), L); show(L); ?M::q(Y); show(M,Y)."
    assert deeds(text) == ["show([(a-1),(b-2),(default-3)])", "show(a,4)"]


def test_plans_goals_and_beliefs_with_a_variable_namespace() -> None:
    text = """+!N::greet(X) <- +N::met(X); ?N::met(Y); show(N,Y); -N::met(Y); !N::leave.
        +N::met(X)[source(S)] <- noted(N,S). +!leave <- wrong. +!b::leave <- left. !a::greet(1). !b::greet(2)."""
    seen = deeds(text)
    assert [deed for deed in seen if "show" in deed or "left" in deed] == ["show(a,1)", "show(b,2)", "left"]
    assert seen.count("noted(a,self)") == seen.count("noted(b,self)") == 1


def test_a_test_goal_with_a_variable_namespace_falls_back_on_plans() -> None:
    assert deeds("!go(a). +!go(N) <- ?N::price(P); show(P). +?a::price(7).") == ["show(7)"]


def test_a_term_gets_its_namespace_once_the_variable_has_a_value() -> None:
    assert deeds("!go(a). +!go(N) <- X = f(N::b); N2 = c; Y = N2::d(1); show(X,Y,default::e).") == [
        "show(f(a::b),c::d(1),e)"
    ]


def test_a_variable_name_in_a_namespace_stands_for_what_is_in_it() -> None:
    text = """a::p(1). a::q(2). b::p(3). p(4). !go.
        +!go <- .setof(X, a::X, L); show(L); .abolish(a::_); .setof(N-Y, N::p(Y), M); show(M).
        -a::X <- gone(X)."""
    assert sorted(deeds(text)) == [
        "gone(p(1)[source(self)])",
        "gone(q(2)[source(self)])",
        "show([(b-3),(default-4)])",
        "show([p(1),q(2)])",
    ]


def test_goals_of_one_namespace_are_dropped_by_a_variable_name() -> None:
    text = """!a::g. !a::h(1). !b::g. {begin namespace(a)} +!g <- work; late. +!h(X) <- work; late. {end}
        +!b::g <- work; .drop_desire(a::_); done."""
    agent = Agent(parse_program(text))
    started = [action for _ in range(4) for action in agent.cycle().actions]
    assert [str(action) for action in started] == ["work", "work", "work"]
    assert done_by_all(agent, [started[2].id]) == ["done"]


def done_by_all(agent: Agent, finished: list[int]) -> list[str]:
    outcomes = [agent.cycle(finished=[Finished(each) for each in finished]), *(agent.cycle() for _ in range(6))]
    assert sorted(each for outcome in outcomes for each in outcome.cancelled) == [1, 2]
    return [str(action) for outcome in outcomes for action in outcome.actions]


def test_a_term_with_a_variable_namespace_is_matched() -> None:
    text = "k(b::q). !go. +!go <- !h(f(a::p(1))); ?k(N::q); show(N). +!h(f(N::p(X))) <- show(N,X)."
    assert deeds(text) == ["show(a,1)", "show(b)"]


def test_what_is_sent_names_the_namespace_of_its_module() -> None:
    agent = Agent(
        parse_program("{begin namespace(cnp)} !g. +!g <- .send(bob, tell, ::cfp(1)); .send(bob, tell, b). {end}")
    )
    sent = [str(message.content) for _ in range(5) for message in agent.cycle().messages]
    assert sent == ["cnp::cfp(1)", "b"]


@pytest.mark.parametrize("step", ["+N::p(1)", "-N::p(1)", "!N::p(1)", "!!N::p(1)", "N::act", "+a::X"])
def test_a_step_without_its_namespace_fails_by_name(step: str) -> None:
    text = f'!go. +!go <- {step}. -!go[error(E),error_msg(M)] <- .print(E,": ",M). p(1).'
    assert deeds(text) == [f"wrong_arguments: {step.lstrip('+-!')} is no literal"]


def test_annotations_of_what_is_in_a_namespace() -> None:
    text = """a::p(1)[sure]. a::q(2). !a::g[x(1)]. !go. +!go <- .findall(X, a::X[sure], L); .length(L,N); show(N).
        +!a::G[x(K)] <- got(G,K). +a::P[sure] <- is_sure."""
    assert sorted(deeds(text)) == ["got(g[x(1),source(self)],1)", "is_sure", "show(1)"]


def test_a_literal_is_taken_apart_with_its_namespace_and_put_together() -> None:
    text = """!go. +!go <- X = a::p(1)[x]; X =.. [N,F,A,S]; show(N,F,A,S); Y =.. [b,F,A,[]]; show(Y); X =.. [G,B,T];
        show(G,B,T)."""
    assert deeds(text) == ["show(a,p,[1],[x])", "show(b::p(1))", "show(p,[1],[x])"]


def test_a_namespace_of_one_name_unifies_with_no_other() -> None:
    text = "!go. +!go <- if (a::X = b::c) { wrong }; if (a::Y = a::c(1)) { show(Y) }; if (N::c = b::c) { show(N) }."
    assert deeds(text) == ["show(c(1))", "show(b)"]


# ---- the outside ---------------------------------------------------------------------------------------------------


def test_percepts_and_messages_are_in_the_namespace_that_they_name() -> None:
    agent = Agent(parse_program("+line(X) <- out(X). {begin namespace(a)} +line(X) <- inside(X). +!g <- g. {end}"))
    messages = [Message("bob", "tell", "a::line(2)"), Message("bob", "achieve", "a::g")]
    seen = [str(action) for percepts in (["line(1)"], None, None, None) for action in _cycle(agent, percepts, messages)]
    assert sorted(seen) == ["g", "inside(2)", "out(1)"]
    assert agent.believes("a::line(2)[source(bob)]") and not agent.believes("line(2)")


@pytest.mark.parametrize("text", ["N::p(1)", "n::X", "X[a]"])
def test_what_comes_in_has_a_name_and_a_namespace(text: str) -> None:
    agent = Agent(parse_program("b."))
    with pytest.raises(AgentSpeakSyntaxError, match="is not a literal"):
        agent.cycle([text])
    with pytest.raises(NotALiteral):
        agent.cycle(None, [Message("bob", "tell", parse_term(text))])
    assert [str(each) for each in agent.beliefs] == ["b[source(self)]"]


def _cycle(agent: Agent, percepts: list[str] | None, messages: list[Message]) -> list[object]:
    outcome = agent.cycle(percepts, messages if percepts else [])
    return [action.term for action in outcome.actions]


@pytest.mark.parametrize(
    ("written", "shown"),
    [
        ("ns::p(X)[a]", "ns::p(X)[a]"),
        ("ns::~p", "ns::~p"),
        ("~ns::p", "ns::~p"),
        ("NS::p(1)", "NS::p(1)"),
        ("NS::~p", "NS::~p"),
        ("ns::X", "ns::X"),
        ("f(j::uu,A::B)", "f(j::uu,A::B)"),
        ("default::p", "p"),
        ("::p", "p"),
        ("this_ns", "default"),
        ("ns::'a b'", "ns::'a b'"),
    ],
)
def test_terms_with_namespaces_are_written_as_they_are_read(written: str, shown: str) -> None:
    assert str(parse_term(written)) == shown
    assert str(parse_term(shown)) == shown


def test_an_initial_belief_needs_a_namespace_with_a_name() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match=r"<text>:2:1: NS::b has no namespace yet"):
        parse_program("a.\nNS::b.")


# ---- internal actions ----------------------------------------------------------------------------------------------


def test_namespaces_are_listed_and_asked_for() -> None:
    text = """!go. +!go <- +family::brother(bob); +money::account(1); .findall(N, .namespace(N), L); show(L);
        if (.namespace(family) & not .namespace(nowhere)) { yes }."""
    assert deeds(text) == ["show([default,family,money])", "yes"]


def test_namespaces_have_properties() -> None:
    text = """!go. +!go <- .namespace_set_prop(f,uri,"u"); .namespace_set_prop(f,size,4); .namespace_set_prop(f,size,5);
        .namespace_get_prop(f,uri,U); .namespace_get_prop(f,kind,K,none); .findall(X-Y, .namespace_get_prop(f,X,Y), L);
        .findall(X, .namespace_get_prop(f,X), M); show(U,K,L,M); if (not .namespace_get_prop(g,uri,_)) { none_of_g }."""
    assert deeds(text) == ['show("u",none,[(uri-"u"),(size-5)],[uri,size])', "none_of_g"]


def test_a_module_is_loaded_while_the_agent_runs() -> None:
    text = """!start([tv,pc]). +!start([]). +!start([T|R]) <- .include("shop.asl",T); !!T::sell; !start(R).
        +N::sold(P) <- show(N,P)."""
    shop = "{namespace(priv,local)} priv::price(9). +!sell : priv::price(P) <- +sold(P)."
    assert sorted(deeds(text, shop=shop)) == ["show(pc,9)", "show(tv,9)"]


def test_what_is_loaded_believes_and_wants_at_once_and_in_a_fresh_namespace_on_request() -> None:
    text = """!go. +!go <- .include("shop.asl"); .include("shop.asl",N); .include("shop.asl",M);
        N \\== M; ?N::b(X); show(X)."""
    assert sorted(deeds(text, shop="b(1). !g. +!g : b(X) <- g(X).")) == ["g(1)", "g(1)", "g(1)", "show(1)"]


def test_loading_needs_leave_and_fails_by_name() -> None:
    text = '!go. +!go <- .include("shop.asl",a). -!go[error(E),error_msg(M)] <- failed(E); .print(M).'
    refused = done_by(Agent(parse_program(text)))
    assert refused == [
        "failed(ia_failed)",
        ".include reads a file, and this agent may not: it was made without includes=",
    ]
    missing = deeds(text)
    assert missing[0] == "failed(wrong_arguments)" and "cannot include shop.asl: there is no shop.asl" in missing[1]
    broken = deeds(text, shop="+!g <- .nonsense. b(1).")
    assert "there is no internal action .nonsense" in broken[1]
