"""The robot's activity in words for people: from the actions its intentions wait for.

The goal is the stop that comes next; what is waited for is the last action that has not ended.
"""

from collections.abc import Callable, Sequence
from typing import Final

from protocol.parts import StopAction
from protocol.to_server import Why
from robot.agent.navigator import Navigator
from robot.mission.mission import MissionManager
from robot.reflexes import FAULTS, Response
from robot.skills.interfaces import View

_STAND: Final = {fault.name: fault.told for fault in FAULTS if fault.response is not Response.NOTHING}
"""The faults that a robot stands for; others are told, but are no reason for what it does."""
TAKEN_AWAY: Final = "Waiting to be put down at a post or in a dock"
LONG_AWAY: Final = Why(sentence="Waiting for the service, after a long time without it", waiting_for="the network")
OWN_ACTION: Final = "Carrying out its program"
"""Of an action that is over at once, or that is another program's own: its name would tell people nothing."""
_PURPOSES: Final = {
    StopAction.LOAD: "to collect mail at {post}",
    StopAction.RECEIVE: "to deliver mail at {post}",
    StopAction.RETURN: "to bring mail back to {post}",
    StopAction.DOCK: "to the dock at {post}",
    StopAction.PARK: "to park at {post}",
}


def _driving(navigator: Navigator) -> str:
    towards = navigator.towards
    return f"Driving towards {towards}" if towards else "Following the line to the next post"


_WAITS: Final[dict[str, Callable[[Navigator], tuple[str, str | None]]]] = {
    "follow_line": lambda n: (_driving(n), None),
    "turn": lambda n: (f"Turning at {n.here}", None),
    "find_line": lambda _: ("Looking for the line", None),
    "look_back": lambda n: (f"Looking for the marker of {n.towards or n.here}", None),
    "dock": lambda n: (f"Docking at {n.here}", None),
    "undock": lambda n: (f"Leaving the dock at {n.here}", None),
    "claim": lambda n: (f"Waiting at {n.here} for permission to drive on", "permission from the server"),
    "wait_handover(load": lambda n: (f"Waiting for the sender at {n.here}", "the sender's code"),
    "wait_handover(return": lambda n: (f"Waiting at {n.here} for the mail to be taken back", "a code"),
    "wait_handover(receive": lambda n: (f"Waiting for the recipient at {n.here}", "the recipient's code"),
    "rest": lambda _: ("Waiting a moment before trying again", None),
    "drive": lambda n: (_driving(n), None),
    "station(dock": lambda n: (f"Docking at {n.here}", None),
    "station(undock": lambda n: (f"Leaving the dock at {n.here}", None),
    "say": lambda _: ("Playing a tune", None),
}


def reason(under_way: Sequence[str], view: View, navigator: Navigator, missions: MissionManager, charging: bool) -> Why:
    """One sentence, the goal behind it, and what it waits for."""
    stop = missions.held.stop
    goal = _PURPOSES[stop.action].format(post=stop.post) if stop else None
    for fault in sorted(view.faults & _STAND.keys()):
        return Why(sentence=_STAND[fault], goal=goal, waiting_for="a person" if fault != "bump" else "a free way")
    if missions.held.revoked or (navigator.doubted and not under_way):
        return Why(sentence=TAKEN_AWAY, goal=goal, waiting_for="a person")
    if missions.custody.handing_over:
        return Why(sentence=f"Giving people at {navigator.here} a moment to step back", goal=goal)
    if under_way:
        sentence, waiting_for = _of_action(under_way[-1], navigator)
        if under_way[-1].startswith("claim(") and not missions.online:
            # Offline the robot goes on within its grants; the next one can only come when it is reached again.
            sentence, waiting_for = f"Waiting at {navigator.here} for the network", "the network"
        return Why(sentence=sentence, goal=goal, waiting_for=waiting_for)
    if view.heard_base and view.heard_base.docked:
        doing = "Charging" if charging else "In its dock"
        waiting_for = "a full battery" if stop and charging else None
        return Why(sentence=f"{doing} at {navigator.here}", goal=goal, waiting_for=waiting_for)
    return Why(sentence="Paused" if missions.held.paused else "Nothing to do", goal=goal)


def _of_action(action: str, navigator: Navigator) -> tuple[str, str | None]:
    for beginning, words in _WAITS.items():
        if action.startswith(beginning):
            return words(navigator)
    return OWN_ACTION, None
