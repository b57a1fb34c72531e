"""Orders that a robot takes along: where they fit, never more than it can carry, only those on its way."""

from itertools import pairwise, permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.dispatch.at_once.missions import best_tour
from app.dispatch.choice import WaitingOrder
from app.dispatch.insertion import Tour, Visit, cheapest_insertion
from maps.ways import Ways
from tests.plain_maps import plain_map

MAP = plain_map("carleton")
WAYS = Ways(MAP)
TRACK = Ways(plain_map("test_track"))
LOAD, RECEIVE = Visit("load", "post2", 1), Visit("receive", "post3", -1)


def tour(*visits: Visit, start: str | None = "post1", aboard: int = 0, robot: str = "r1") -> Tour:
    return Tour(robot, start, visits, aboard)


FETCH, BRING = Visit("fetch", "post1", 1), Visit("bring", "post4", -1)


def test_what_lies_on_the_way_is_taken_along_without_a_detour() -> None:
    found = cheapest_insertion(tour(FETCH, BRING), LOAD, RECEIVE, 2, TRACK)
    assert found is not None
    assert found.visits == (FETCH, LOAD, RECEIVE, BRING)
    assert found.detour_m == 0


def test_a_full_robot_gives_first_and_loads_then() -> None:
    found = cheapest_insertion(tour(FETCH, BRING), LOAD, RECEIVE, 1, TRACK)
    assert found is not None
    assert found.visits in {(LOAD, RECEIVE, FETCH, BRING), (FETCH, BRING, LOAD, RECEIVE)}
    carrying = cheapest_insertion(tour(BRING, aboard=1), LOAD, RECEIVE, 1, TRACK)
    assert carrying is not None
    assert carrying.visits == (BRING, LOAD, RECEIVE)


def test_a_robot_whose_place_is_unknown_goes_to_its_next_stop_first() -> None:
    found = cheapest_insertion(tour(BRING, start=None, aboard=1), LOAD, RECEIVE, 2, TRACK)
    assert found is not None
    assert found.visits[0] is BRING


def test_only_a_small_detour_is_made_and_the_smallest_one() -> None:
    here = tour(FETCH, BRING, robot="here")
    away = tour(Visit("f", "post4", 1), Visit("b", "post5", -1), start="post4", robot="away")
    order = WaitingOrder("o", "post2", "post3")
    assert (best_tour(order, [away, here], TRACK, 2, 0.5) or [None])[0] is here
    back = WaitingOrder("o", "post3", "post1")
    assert best_tour(back, [tour(BRING, start="post4", aboard=1)], TRACK, 2, 0.1) is None


def test_a_robot_that_may_not_fetch_an_order_does_not_take_it_along() -> None:
    assert best_tour(WaitingOrder("o", "post2", "post3", avoided="r1"), [tour(FETCH, BRING)], TRACK, 2, 9) is None
    assert best_tour(WaitingOrder("o", "post2", "post3", wanted="r2"), [tour(FETCH, BRING)], TRACK, 2, 9) is None


@pytest.mark.parametrize("place", ["nowhere", ""])
def test_what_cannot_be_got_to_is_not_taken_along(place: str) -> None:
    assert cheapest_insertion(tour(FETCH, BRING), Visit("load", place, 1), RECEIVE, 2, TRACK) is None


posts = st.sampled_from(sorted(MAP.posts))
pairs = st.lists(st.tuples(posts, posts), min_size=0, max_size=2)


@given(pairs, posts, st.tuples(posts, posts), st.integers(1, 3), st.booleans())
def test_no_other_way_of_doing_it_in_the_same_order_is_shorter(
    before: list[tuple[str, str]], start: str, new: tuple[str, str], capacity: int, is_known: bool
) -> None:
    visits = tuple(
        Visit(f"{what}{number}", post, change)
        for number, pair in enumerate(before)
        for what, post, change in (("f", pair[0], 1), ("b", pair[1], -1))
    )
    load, receive = Visit("load", new[0], 1), Visit("receive", new[1], -1)
    found = cheapest_insertion(Tour("r", start if is_known else None, visits), load, receive, capacity, WAYS)
    if not is_known and not visits:
        return
    assert found is not None, "one after the other is always possible"
    assert [one for one in found.visits if one in visits] == list(visits)
    assert found.visits.index(load) < found.visits.index(receive)
    aboard = [sum(one.change for one in found.visits[: n + 1]) for n in range(len(found.visits))]
    assert max(aboard) <= capacity
    for other in permutations(found.visits):
        keeps_order = [one for one in other if one in visits] == list(visits)
        room = max(sum(one.change for one in other[: n + 1]) for n in range(len(other))) <= capacity
        if keeps_order and room and other.index(load) < other.index(receive) and (is_known or other[0] in visits):
            known = start if is_known else None
            assert length_m(known, found.visits) <= length_m(known, other) + 1e-9


def length_m(start: str | None, visits: tuple[Visit, ...]) -> float:
    places = [*([start] if start else []), *(one.post for one in visits)]
    return sum(WAYS.length_m(one, two) for one, two in pairwise(places))
