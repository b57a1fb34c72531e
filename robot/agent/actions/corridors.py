"""Knowing the way and being allowed to take it: what the actions about routes, grants and closed corridors do."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Final

from maps import NoRoute, corridor_name, shortest_route
from protocol.parts import Leg
from robot.agent.actions.arguments import Value
from robot.agent.actions.hands import Hands
from robot.agent.actions.runs import DONE, AtOnce, Ended, Run, Wait

WAY_BLOCKED: Final = "way_blocked"
AWAITS_NETWORK_S: Final = 120.0
"""So long a robot waits for an answer where it stands: a service that is started anew is there again sooner."""
CLOSED_BY: Final = {
    "blocked": "Something stands in it",
    "virtual_wall": "A virtual wall guards it",
    "post_missed": "No marker was found at its far end",
}


def set_destination(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    destination = str(arguments[0])
    if _why_no_way(hands, destination) == "no_route":
        return AtOnce(Ended("no_route"))
    hands.navigator.destination = destination
    return AtOnce()


def _why_no_way(hands: Hands, goal: str) -> str | None:
    """None: there is a way. `way_closed`: not now, a corridor is blocked or denied. `no_route`: none on the map."""
    navigator = hands.navigator
    try:
        navigator.legs_to(goal)
        return None
    except NoRoute:
        pass
    try:
        shortest_route(navigator.campus, navigator.here or goal, goal)
    except NoRoute:
        return "no_route"
    return "way_closed"


def claim(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    """Done as soon as the first corridor of the way may be entered: from post to post it is asked again. Done as well
    when the robot has to go elsewhere first, which is then perceived: the service sends it there, or it goes on out of
    a hole in the network by what it was granted."""
    goal, missions, navigator = str(arguments[0]), hands.missions, hands.navigator
    closed = _why_no_way(hands, goal)
    way = _kept(hands) if closed else _way(hands, goal)
    first = _from_here(hands, way) if closed else navigator.first_legs(goal)
    _give_back(hands, first, way)
    if closed:
        missions.claims.avoid = frozenset()  # what was denied may be open by the next time it asks
        return AtOnce(Ended(closed))
    asks = not (navigator.detour or (navigator.asks_ahead_later and missions.claims.may_enter(first)))
    claim_id = missions.claims.ask((*first, *way), goal) if asks else None
    asked_s = hands.view.at_s

    def ask() -> Ended | None:
        _give_back(hands, first, way)  # it may have been granted what it asked for before it changed its mind
        if missions.claims.may_enter(first) or navigator.detour:
            return DONE
        if leg := _way_out_of_silence(hands, asked_s):
            missions.claims.turn_aside(leg)
            return DONE
        return Ended("denied") if claim_id and missions.claims.denial(claim_id) else None

    return Wait(ask, dropped=missions.claims.withdraw)


def _give_back(hands: Hands, first: Sequence[Leg], way: Sequence[Leg]) -> None:
    """Release corridors that it does not need while it stands in none of them. Without network it keeps all: no other
    robot would come to know, and it may be the only way out of there."""
    if hands.navigator.at and hands.missions.online:
        kept = (*first, *_granted_ahead(hands, way), hands.navigator.detour)
        hands.missions.claims.clear(leg for leg in hands.missions.held.grants if leg not in kept)


def _from_here(hands: Hands, legs: Sequence[Leg]) -> tuple[Leg, ...]:
    return tuple(leg for leg in legs if leg.from_post == hands.navigator.at)


def _granted_ahead(hands: Hands, way: Sequence[Leg]) -> Iterator[Leg]:
    """Yield the legs that it may drive through from here without a stop. A corridor to which it comes only after
    others, not granted yet, is not kept: the service thinks the robot in what it holds, and grants it nothing
    meanwhile."""
    end, granted = hands.navigator.at, hands.missions.held.grants
    for leg in way:
        if leg not in granted or leg.from_post != end:
            return
        end = leg.to_post
        yield leg


def _way_out_of_silence(hands: Hands, asked_s: float) -> Leg | None:
    """A corridor from here that it holds and has not come through yet, where no answer can reach it; None while one may
    come. Out of a bay that is the one beyond the crossing."""
    if "link_loss" not in hands.view.faults or hands.view.at_s - asked_s < AWAITS_NETWORK_S:
        return None
    navigator, grants = hands.navigator, hands.missions.held.grants
    here = navigator.at or ""
    post = navigator.campus.address_of(here)
    if post != here and Leg(from_post=here, to_post=post) not in grants:
        return None
    unused = (leg for leg in grants if leg.from_post == post and leg not in navigator.crossed)
    open_ones = (leg for leg in unused if not _is_closed(hands, leg))
    return next((leg for leg in open_ones if post == here or not navigator.campus.post(leg.to_post).bay_of), None)


def _is_closed(hands: Hands, leg: Leg) -> bool:
    return corridor_name(leg.from_post, leg.to_post) in hands.navigator.closed.names


def _way(hands: Hands, goal: str) -> tuple[Leg, ...]:
    """The way to the goal, the rest of the mission and home: a robot without network finishes what it is permitted, and
    comes back to where it can tell of it."""
    held, navigator = hands.missions.held, hands.navigator
    later = [stop.post for stop in (held.mission.stops if held.mission else ())[held.next_stop :]]
    home = [navigator.home] if navigator.home else []
    try:
        return navigator.legs_to(goal, *(later if later[:1] == [goal] else []), *home)
    except NoRoute:
        return navigator.legs_to(goal)


def _kept(hands: Hands) -> tuple[Leg, ...]:
    """Return the corridors that it goes on holding while no way is open. Where another robot is in the way it lets go
    of everything, so that this one can go on. Where something stands in a corridor it keeps what it has been granted:
    without network there
    it would never be granted anything again."""
    return () if hands.missions.claims.avoid else hands.missions.held.grants


class AskAhead:
    """On the way to a post with bays: ask for what comes after it, once for each way that it would take."""

    def __init__(self, hands: Hands) -> None:
        self._hands = hands
        self._asked: tuple[Leg, ...] = ()

    def __call__(self) -> None:
        navigator, goal = self._hands.navigator, self._hands.navigator.destination
        if not navigator.nears_a_crossing or navigator.may_cross():
            return
        with suppress(NoRoute):
            legs = navigator.legs_to(goal or navigator.waits_before or "")
            if legs != self._asked:
                self._asked = legs
                self._hands.missions.claims.ask(legs, goal)


def wait_to_cross(hands: Hands, _: Sequence[Value], __: float) -> Run:
    """Done when it may drive on: over the post, into a bay there, or where the service sends it. Denied the corridor
    that it is in it has to turn back; so has one that turned round on its way into its bay."""
    navigator, claims = hands.navigator, hands.missions.claims
    goals = [goal for goal in (navigator.destination, navigator.waits_before) if goal]
    claim_id: str | None = None

    def ask() -> Ended | None:
        nonlocal claim_id
        if navigator.may_cross():
            return DONE
        if _comes_back_from_its_bay(hands):
            return Ended("turn_back")
        denial = claims.denial(claim_id) if claim_id else None
        if denial and navigator.corridor in denial.avoid:
            return Ended("turn_back")
        if denial and len(goals) > 1:
            del goals[0]
        if _why_no_way(hands, goals[0]) is not None:
            return Ended("way_closed")
        claim_id = claims.ask(navigator.legs_to(goals[0]), goals[0])
        return None

    return Wait(ask, dropped=claims.withdraw)


def _comes_back_from_its_bay(hands: Hands) -> bool:
    """It has turned round before it was in. That bay is kept for it, and it is let out of there."""
    leg, campus = hands.navigator.corridor, hands.navigator.campus
    if leg is None or leg.from_post != hands.navigator.waits_before or not campus.post(leg.to_post).bay_of:
        return False
    return leg in hands.missions.held.grants and not _is_closed(hands, leg)


def release(hands: Hands, _: Sequence[Value], __: float) -> Run:
    hands.missions.claims.withdraw()
    here = hands.navigator.corridor
    inside = {here.from_post, here.to_post} if here else None
    hands.missions.claims.clear(leg for leg in hands.missions.held.grants if {leg.from_post, leg.to_post} != inside)
    return AtOnce()


def turned_back(leg: Leg, why: str) -> str:
    """Return the message for people; the service reads from it which corridor is closed."""
    return f"The robot turned back in the corridor from {leg.from_post} to {leg.to_post}. {CLOSED_BY[why]}."


def tried_again(corridor: str) -> str:
    """The same, when it is over."""
    return "The robot tries the corridor between {} and {} again.".format(*corridor.split("-"))


def mark_blocked(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    leg, why = hands.navigator.corridor, str(arguments[0])
    if leg is None:
        return AtOnce(Ended("not_in_a_corridor"))
    if corridor_name(leg.from_post, leg.to_post) not in hands.navigator.closed.names:
        hands.missions.report_one_fault(WAY_BLOCKED, turned_back(leg, why), hands.place, cleared=False, lasts=True)
    # Last: killed in between, the robot tells after its restart that it tries this way again, and does.
    hands.navigator.closed.close(leg, now)
    return AtOnce()


def reopen(hands: Hands, _: Sequence[Value], __: float) -> Run:
    hands.navigator.closed.open_all()
    return AtOnce()


def noted_move(hands: Hands, _: Sequence[Value], __: float) -> Run:
    hands.navigator.noted_move()
    return AtOnce()
