"""Every action that a program may ask for: what it takes, what it means, and what it starts.

To give the agent something new to do, add a row. An action ends done or failed(reason); nothing is ever ignored.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, get_args

from protocol.parts import Purpose
from protocol.to_server import Step
from robot.agent.actions.arguments import Argument, Kind, Value, word
from robot.agent.actions.corridors import (
    CLOSED_BY,
    AskAhead,
    claim,
    mark_blocked,
    noted_move,
    release,
    reopen,
    set_destination,
    wait_to_cross,
)
from robot.agent.actions.hands import PLACE_UNKNOWN, Hands
from robot.agent.actions.runs import AtOnce, Ended, Meanwhile, Rest, Run, SkillMaker, Skills, ThenRest, Unless
from robot.mission.custody import Waiting
from robot.mission.mission import ChargeStep
from robot.skills import Dock, DrivePulse, FindLine, FollowLine, LookBack, PaperTurn, Say, Turn, Undock, WaitHandover
from robot.skills.find_line import WIDEST_RAD, over_line
from robot.skills.interfaces import Done, Skill
from robot.skills.tunes import TUNES


@dataclass(frozen=True)
class Action:
    """One row. `begin` is called with checked arguments and returns at once."""

    name: str
    takes: tuple[Argument, ...]
    about: str
    begin: Callable[[Hands, Sequence[Value], float], Run]


def _one(
    hands: Hands,
    skill: Skill,
    now: float,
    then: Callable[[Done], None] | None = None,
    rescue: Mapping[str, SkillMaker] | None = None,
) -> Run:
    return Skills(hands.body, [lambda: skill], now, then, rescue)


# Moving.

ALONE_RAD = WIDEST_RAD + math.radians(20)
"""A line is the only one that may be under the diodes if no other lies within this: the way it believes to look may be
wrong by so much, after a restart in a turn that it began aslant."""
FOLLOW_LEAST_S, FOLLOW_TIMES = 180.0, 3.0
"""The watchdog of the way: so many times the time that the corridor should take, and a while for searches."""


def _follow_line(hands: Hands, _: Sequence[Value], now: float) -> Run:
    """Along the line. A robot that looks aslant straightens up first, unless it stands over the only line ahead; one
    that does not know which way it looks turns until it sees a line."""
    navigator = hands.navigator
    if navigator.doubted:
        return AtOnce(Ended(PLACE_UNKNOWN))
    if (deeper := navigator.goes_deeper) and not hands.missions.claims.may_be_in(deeper):
        return AtOnce(Ended("not_granted"))
    aslant_rad = navigator.aslant_rad

    def straighten() -> Skill | None:
        on_the_line = abs(aslant_rad) < WIDEST_RAD and over_line(hands.view) and navigator.lines_ahead(ALONE_RAD) <= 1
        if on_the_line or not (aslant_rad or navigator.looks_anywhere):
            return None
        if not aslant_rad:
            return FindLine(hands.shape, looks_anywhere=True)
        navigator.begin_turn()
        return Turn(aslant_rad, hands.shape, hands.turn_mm_s)

    def follow() -> Skill:
        if aslant_rad:
            navigator.turned()
        navigator.leave()
        limit_s = FOLLOW_LEAST_S + FOLLOW_TIMES * navigator.ahead_m * 1000 / hands.cruise_mm_s
        left_mm = navigator.way_left_mm
        return FollowLine(
            navigator.campus,
            navigator.came_from,
            hands.cruise_mm_s,
            hands.shape,
            limit_s,
            left_mm,
            navigator.towards,
            navigator.goes_by_length,
            navigator.sighted,
            navigator.expected(),
            navigator.may_cross,
        )

    run = Skills(hands.body, [straighten, follow], now, lambda done: navigator.reached(done.result, done.unread))
    return Meanwhile(run, AskAhead(hands))


def _look_back(hands: Hands, _: Sequence[Value], now: float) -> Run:
    """Not farther back than half of the corridor that it holds."""
    return _one(hands, LookBack(hands.navigator.doubted, hands.navigator.look_back_mm), now)


def _turn(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    angle_rad = hands.navigator.turn_rad(str(arguments[0]))
    hands.navigator.begin_turn()
    return _one(hands, Turn(angle_rad, hands.shape, hands.turn_mm_s), now, lambda _: hands.navigator.turned())


def _paper_turn(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    angle_rad = hands.navigator.turn_rad(str(arguments[0]))
    return _one(hands, PaperTurn(angle_rad), now, lambda _: hands.navigator.turned())


def _drive(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    return _one(hands, DrivePulse(str(arguments[0])), now)


def _find_line(hands: Hands, _: Sequence[Value], now: float) -> Run:
    return _one(hands, FindLine(hands.shape), now)


def _dock(hands: Hands, _: Sequence[Value], now: float) -> Run:
    hands.navigator.begin_docking()
    return _one(hands, Dock(), now)


def _undock(hands: Hands, _: Sequence[Value], now: float) -> Run:
    """A dock stands beside the tape's end: with a wheel worn, the robot comes out a hand's breadth beside the line."""
    look_about = {"line_lost": lambda: FindLine(hands.shape)}
    undock = Undock(hands.shape, *hands.navigator.undock_way())
    hands.navigator.begin_docking()
    return _one(hands, undock, now, lambda _: hands.navigator.undocked(), look_about)


def _station(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    return {"dock": _dock, "undock": _undock}[str(arguments[0])](hands, (), now)


# The mission.


def _report(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    if arguments[0] == Step.PASSED and hands.navigator.comes_out_of_a_bay:
        return AtOnce()
    hands.report(Step(str(arguments[0])), str(arguments[1]), str(arguments[2]) if len(arguments) > 2 else None)
    return AtOnce()


def _finish_stop(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    hands.missions.finish_stop(str(arguments[0]))
    return AtOnce()


def _finish_mission(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    hands.missions.finish_mission(str(arguments[0]), hands.place)
    return AtOnce()


STANDS_FOR_HANDS_S = 5.0
"""So long the robot stands after the tune that says yes, for a person to put mail into its box or to take it out and to
step back. Assumed: how long people take has not been measured."""


def _wait_handover(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    purpose, order_id, stop_id, limit_s = Purpose(str(arguments[0])), str(arguments[1]), str(arguments[2]), arguments[3]
    missions, place = hands.missions, hands.missions.at_stop(stop_id)
    waiting = Waiting(place, purpose, hands.place or place[1].post)

    def promise() -> None:
        """Written down first, then promised: a person who hears the tune may let go of the mail."""
        hands.body.start(Say("accepted"), now)

    def custody(done: Done) -> None:
        missions.handed_over(place, purpose, waiting.post, done.shown)
        waiting.handed_over = True
        promise()

    def spot_counts() -> bool:
        """Only loading may be confirmed by the Spot button: it identifies no person."""
        return purpose is Purpose.LOAD and missions.loads_nothing_else(order_id, waiting.post)

    skill = WaitHandover(lambda: missions.codes(order_id, purpose), float(limit_s), spot_counts)
    missions.custody.wait(waiting)
    run: Run = Unless(_one(hands, skill, now, custody), lambda: waiting.handed_over, promise)
    # The network may come back while it stands here, and others wait for what lies behind it.
    run = Meanwhile(run, hands.navigator.give_back_crossed)
    return ThenRest(run, STANDS_FOR_HANDS_S, lambda: missions.custody.leave(waiting))


def _report_charge(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    step: ChargeStep = next(step for step in get_args(ChargeStep) if step == arguments[0])
    base = hands.view.base
    hands.missions.report_charge(step, hands.place, (base and base.battery_ratio) or 0.0)
    return AtOnce()


def _raise_fault(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    hands.missions.report_fault(str(arguments[0]), f"The robot met a problem: {arguments[1]}.", hands.place)
    return AtOnce()


def _clear_fault(hands: Hands, arguments: Sequence[Value], _: float) -> Run:
    hands.missions.report_fault(str(arguments[0]), "It is over.", hands.place, cleared=True)
    return AtOnce()


# People.


def _say(hands: Hands, arguments: Sequence[Value], now: float) -> Run:
    return _one(hands, Say(str(arguments[0])), now)


def _rest(_: Hands, arguments: Sequence[Value], now: float) -> Run:
    return Rest(now + float(arguments[0]))


_POST = Argument("Post", Kind.POST)
_STOP = Argument("Stop", Kind.NAME)
_ORDER = Argument("Order", Kind.NAME)
_NAME = Argument("Name", Kind.NAME)
_REASON = Argument("Reason", Kind.TERM)
_SECONDS = Argument("Seconds", Kind.NUMBER)
_STEP = word("Step", *(step.value for step in Step))

ACTIONS: Final = (
    Action(
        "follow_line",
        (),
        "follow the line to the next marker; fails with not_granted in a corridor that it came into ungranted, with "
        "must_wait before a post with bays where it has been granted no way on",
        _follow_line,
    ),
    Action("look_back", (), "back a little, until the marker of the post ahead is read", _look_back),
    Action("turn", (word("Way", "left", "right", "behind"),), "turn on the spot, by the map's angle", _turn),
    Action("find_line", (), "look for the line nearby", _find_line),
    Action("dock", (), "drive into the dock ahead, until it charges", _dock),
    Action("undock", (), "back out of the dock, onto the line", _undock),
    Action("set_destination", (_POST,), "where `direction` leads; fails with unknown_post, no_route", set_destination),
    Action(
        "claim",
        (_POST,),
        "ask for the corridors to a post, give back all others that the service can be told of; done when the first "
        "may be entered, or when `detour` holds; fails with denied, way_closed, no_route",
        claim,
    ),
    Action(
        "wait_to_cross",
        (),
        "ask for the way on from the post ahead, or else for a bay there; done when it may drive on; fails with "
        "turn_back where others stand on the post, with way_closed",
        wait_to_cross,
    ),
    Action(
        "release", (), "give back every corridor that was granted, but for the one it is in, and wait for none", release
    ),
    Action(
        "mark_blocked",
        (word("Why", *CLOSED_BY),),
        "tell that the corridor it is in is closed; no way leads there for ten minutes",
        mark_blocked,
    ),
    Action("reopen", (), "corridors in which it turned back may be tried again", reopen),
    Action("noted_move", (), "it knows that it was moved", noted_move),
    Action("report", (_STEP, _STOP), "tell the server how far the mission is; once for each step", _report),
    Action("report", (_STEP, _STOP, _REASON), "the same, with a reason", _report),
    Action("finish_stop", (_STOP,), "the stop is done or given up", _finish_stop),
    Action("finish_mission", (Argument("Mission", Kind.NAME),), "all stops are done", _finish_mission),
    Action(
        "wait_handover",
        (word("Purpose", *Purpose), _ORDER, _STOP, Argument("Limit_s", Kind.NUMBER)),
        "wait for a person's code; done when mail has changed hands and people have had time to reach into the box; "
        "fails with no_one_came",
        _wait_handover,
    ),
    Action("report_charge", (word("Step", *get_args(ChargeStep)),), "tell how charging goes", _report_charge),
    Action("raise_fault", (_NAME, _REASON), "tell people of a trouble, once until it is cleared", _raise_fault),
    Action("clear_fault", (_NAME,), "it is over", _clear_fault),
    Action("say", (word("Tune", *TUNES),), "a tune and a light", _say),
    Action("rest", (_SECONDS,), "do nothing for a while, before trying again", _rest),
)
"""What our own program uses."""

PAPER_ACTIONS: Final = (
    Action(
        "drive",
        (word("Direction", "forward", "left", "right", "stop", "spiral"),),
        "a pulse of 0.2 s; done at once",
        _drive,
    ),
    Action(
        "turn", (word("Direction", "left", "right"),), "turn until the line is centred; fails after 10 s", _paper_turn
    ),
    Action("setDestination", (_POST,), "where `direction` leads", set_destination),
    Action("station", (word("What", "dock", "undock"),), "the same as dock and undock", _station),
)
"""The vocabulary of the paper's prototype; where a name is in both tables, a foreign program means this one."""
