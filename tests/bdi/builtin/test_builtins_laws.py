"""Laws of lists, sets, strings and queues that hold for all values."""

from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from bdi import Agent, Program, Term, parse_term, show
from bdi.language.terms import List, String, atom, number, structure
from bdi.language.unify import resolve

agent = Agent(Program("laws"))
atoms = st.sampled_from("abcdef").map(atom)
numbers = st.integers(-50, 50) | st.floats(-50, 50, allow_nan=False).map(number)
strings = st.text("abcXYZ 019", max_size=6).map(String)
terms: st.SearchStrategy[Any] = st.recursive(
    atoms | numbers | strings,
    lambda inner: st.lists(inner, max_size=3).map(List) | st.builds(lambda a: structure("f", a), inner),
    max_leaves=6,
)
lists = st.lists(terms, max_size=8).map(List)
short = settings(max_examples=60, deadline=None)


def only(call: str, *values: Term) -> Any:
    """The one value of X; `?` stands for the values in turn."""
    found = every(call, *values)
    assert len(found) == 1
    return found[0]


def every(call: str, *values: Term) -> list[Any]:
    for value in values:
        call = call.replace("?", show(value), 1)
    return [answer.get("X") for answer in agent.ask(call)]


@short
@given(lists)
def test_sorting_keeps_every_item_and_sorting_twice_changes_nothing(items: List) -> None:
    once = only(".sort(?,X)", items)
    assert sorted(map(show, once)) == sorted(map(show, items))
    assert only(".sort(?,X)", once) == once


@short
@given(lists)
def test_the_first_of_the_sorted_is_the_smallest_and_the_last_the_largest(items: List) -> None:
    in_order = only(".sort(?,X)", items)
    assert every(".min(?,X)", items) == list(in_order[:1])
    assert [show(each) for each in every(".max(?,X)", items)] == [show(each) for each in in_order[-1:]]


@short
@given(lists, lists)
def test_reversing_a_joined_list_joins_the_reversed(left: List, right: List) -> None:
    joined = only(".concat(?,?,X)", left, right)
    backwards = only(".concat(?,?,X)", only(".reverse(?,X)", right), only(".reverse(?,X)", left))
    assert only(".reverse(?,X)", joined) == backwards
    assert only(".reverse(?,X)", backwards) == joined


@short
@given(lists)
def test_every_cut_of_a_list_joins_to_it_again(items: List) -> None:
    cuts = agent.ask(f".concat(L,R,{show(items)})")
    assert len(cuts) == len(items) + 1
    assert all(only(".concat(?,?,X)", cut["L"], cut["R"]) == items for cut in cuts)


@short
@given(lists)
def test_prefixes_and_suffixes_are_as_many_as_cuts_and_sublists_hold_them(items: List) -> None:
    prefixes, suffixes = every(".prefix(X,?)", items), every(".suffix(X,?)", items)
    assert len(prefixes) == len(suffixes) == len(items) + 1
    parts = every(".sublist(X,?)", items)
    assert all(part in parts for part in (*prefixes, *suffixes))


@short
@given(lists, lists)
def test_union_intersection_and_difference_are_those_of_sets(left: List, right: List) -> None:
    union = only(".union(?,?,X)", left, right)
    both = only(".intersection(?,?,X)", left, right)
    rest = only(".difference(?,?,X)", left, right)
    assert union == only(".union(?,?,X)", right, left)
    assert set(union) == set(left) | set(right)
    assert set(both) == set(left) & set(right)
    assert set(rest) == set(left) - set(right)
    assert only(".union(?,?,X)", only(".union(?,?,X)", both, rest), right) == union


@short
@given(lists)
def test_a_set_goes_through_its_items_in_order_and_once(items: List) -> None:
    in_set = every(".set.create(S,?) & .member(X,S)", items)
    assert in_set == list(only(".union(?,[],X)", items))


@short
@given(lists)
def test_a_priority_queue_is_always_sorted_and_another_keeps_the_order(items: List) -> None:
    assert only(".queue.create(Q,priority) & .queue.add_all(Q,?) & .queue.to_list(Q,X)", items) == only(
        ".sort(?,X)", items
    )
    assert only(".queue.create(Q) & .queue.add_all(Q,?) & .queue.to_list(Q,X)", items) == items


@short
@given(lists, st.integers(0, 8))
def test_deleting_a_place_leaves_the_others(items: List, place: int) -> None:
    left = only(f".delete({place},?,X)", items)
    assert left == List(items[:place] + items[place + 1 :])


@short
@given(terms)
def test_a_term_as_text_reads_back_as_itself(term: Term) -> None:
    text = only(".term2string(?,X)", term)
    assert resolve(parse_term(str.__str__(text))) == term


@short
@given(strings, strings, strings)
def test_strings_join_as_they_stand_and_hold_their_parts(a: String, b: String, c: String) -> None:
    joined = only(".concat(?,?,?,X)", a, b, c)
    assert str.__str__(joined) == f"{str.__str__(a)}{str.__str__(b)}{str.__str__(c)}"
    start = len(a)
    assert start in every(".substring(?,?,X)", b, joined)
    assert only(f".substring(X,?,{start},{start + len(b)})", joined) == b
    assert only(".length(?,X)", joined) == len(a) + len(b) + len(c)


@short
@given(st.lists(numbers, min_size=1, max_size=8).map(List))
def test_functions_of_lists_of_numbers_agree(items: List) -> None:
    average, low, high = (only(f"X = math.{name}(?)", items) for name in ("average", "min", "max"))
    assert low - 1e-9 <= average <= high + 1e-9
    assert low <= only("X = math.median(?)", items) <= high
    assert abs(only("X = math.sum(?)", items) - average * len(items)) < 1e-6
