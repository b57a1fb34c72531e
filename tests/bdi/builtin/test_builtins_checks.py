"""Calls of internal actions are checked when the agent is made; every internal action is tested."""

import pytest

from bdi import Agent, AgentSpeakError, UnknownInternalAction, parse_program, parse_term
from bdi.builtin import ACTIONS, FUNCTIONS, NOT_SUPPORTED

REFUSED = [
    ("+!g <- .nth(0,foo,X).", "1:8: argument 2 of .nth is a list, string, map, set or queue, not foo"),
    ("+!g <- a;\n  .range(X,a,3).", "2:3: argument 2 of .range is a whole number, not a"),
    ("+!g <- .range(X,1,1+0.5).", "1:8: argument 3 of .range is a whole number, not 1.5"),
    ("+!g : .length(5,_) <- a.", "1:1: argument 1 of .length is"),
    ("r(X) :- .member(X).", "1:1: .member takes 2 arguments, not 1"),
    ("r(X) :- p(X) & not .membre(X,[a]).", "1:1: there is no internal action .membre; did you mean .member"),
    ("+!g <- .concat([a],L).", "1:8: .concat takes 3 or more arguments, not 2"),
    ("+!g <- .substring(a,b,c,d,e).", "1:8: .substring takes 2 to 4 arguments, not 5"),
    ("+!g <- .list_files(L).", "1:8: not supported: .list_files: an agent reads no files"),
    ("b(X) :- X = math.abs(a).", "1:1: argument 1 of math.abs is a number, not a"),
    ("+!g <- X = {a; .nowhere(1)}; X.", "1:16: there is no internal action .nowhere"),
    ("+!g <- .add_plan({+!h <- .nowhere(1)}).", "there is no internal action .nowhere"),
    ("+!g <- .asserta({h(X) :- .nowhere(X)}).", "there is no internal action .nowhere"),
    ("+!g <- a. { +!h <- .nowhere(1). }", "1:20: there is no internal action .nowhere"),
    ("!g(math.abs(1,2)). +!g(X) <- a.", "1:1: math.abs takes 1 argument, not 2"),
    ("b(.nowhere(1)). +!g <- a.", "1:1: there is no internal action .nowhere"),
    ("+!g <: .nowhere(1) <- a.", "1:1: there is no internal action .nowhere"),
    ("+!g <- if (.nowhere(1)) { a }.", "1:8: there is no internal action .nowhere"),
    ("+!g <- courier.distance(1).", "1:8: there is no internal action courier.distance"),
    ("+!g <- courier.start.", "1:8: there is no internal action courier.start; one of your own is a Python function"),
    ("+!g <- .fork(both,{a},{b}).", "1:8: argument 1 of .fork is the word and, or the word or, not both"),
]


@pytest.mark.parametrize(("program", "message"), REFUSED, ids=str)
def test_what_cannot_work_is_refused_when_the_agent_is_made(program: str, message: str) -> None:
    with pytest.raises(UnknownInternalAction) as caught:
        Agent(parse_program(program))
    assert message in str(caught.value)


ACCEPTED = [
    "+!g <- .nth(0,L,X).",
    "+!g <- .range(X,1,N+1); .range(X,0,math.floor(2.5)).",
    "+!g <- .range(X,1,1 div 0).",
    "+!g <- p(file.txt); .print(pkg.name).",
    "+!g <- 'a.b'(1).",
]


@pytest.mark.parametrize("program", ACCEPTED)
def test_what_may_work_is_not_refused(program: str) -> None:
    Agent(parse_program(program))


# ---- nothing is forgotten ------------------------------------------------------------------------------------------

NAMES = """
abolish add_annot add_nested_source add_plan all_names asserta assertz at atom belief broadcast clone concat copy_term
count create_agent current_intention date delete desire df_register df_deregister df_search df_subscribe difference done
drop_all_desires drop_all_events drop_all_intentions drop_desire drop_event drop_future_intention drop_intention empty
eval fail fail_goal findall foreach fork get_src_info ground if_then_else include intend intention intersection join
kill_agent length list list_files list_plans list_rules literal log loop lower_case max member min my_name namespace
namespace_get_prop namespace_set_prop nano_time nth number perceive plan_label prefix print printf println puts
print_unifier random range relevant_plan relevant_plans relevant_rules remove_plan remove_source_annot rename_apart
replace resume reverse save_agent send set_random_seed setof shuffle signal sort stopMAS string structure sublist
substring succeed_goal suffix suspend suspended term2string time type union upper_case verbose version wait
map.create map.put map.get map.remove map.key map.value map.copy map.clear
set.create set.add set.add_all set.remove set.union set.difference set.intersection set.copy set.clear set.to_list
queue.create queue.add queue.add_all queue.head queue.remove queue.copy queue.clear queue.to_list
"""
FUNCTION_NAMES = """
math.abs math.acos math.asin math.atan math.average math.mean math.ceil math.cos math.e math.floor math.log math.max
math.median math.min math.pi math.random math.round math.sin math.sqrt math.std_dev math.sum math.tan .count .length
system.time
"""


def test_every_internal_action_and_function_is_there_or_refused_with_a_reason() -> None:
    wanted = {f".{name}" for name in NAMES.split()}
    assert sorted(wanted - set(ACTIONS) - set(NOT_SUPPORTED)) == []
    assert sorted(set(FUNCTION_NAMES.split()) - set(FUNCTIONS)) == []
    assert not set(NOT_SUPPORTED) & set(ACTIONS)
    assert all(NOT_SUPPORTED.values())


def test_a_name_that_is_none_is_a_syntax_error_or_unknown_never_nothing() -> None:
    with pytest.raises(AgentSpeakError):
        Agent(parse_program("+!g <- .no.such.thing(1)."))
    assert parse_term("'a.b'") != parse_term("a.b")
