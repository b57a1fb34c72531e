"""The table of percepts: what the mind may believe, how it is read, and how old it may become.

Two modes (design: the mind). In `latest` the mind is shown the newest value of everything, so an event means a change.
In `drain` it is shown only what arrived since its last cycle, as the paper's bridge did; the paper's program counts on
that: with `latest`, it would repeat its turns.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from robot.agent.perception.seen import Seen
from robot.core.config import PerceptMode
from robot.skills import FindLine, Turn, Undock

Terms = Iterable[str]
MANOEUVRES: Final = frozenset({FindLine.name, Turn.name, Undock.name})
"""They end by themselves within seconds."""


@dataclass(frozen=True)
class Percept:
    """One row. `read` gives the literals that hold, `age_s` how old they are (None: they are remembered, not sensed).

    `drained` says whether it belongs to the paper's vocabulary and is therefore offered in drain mode.
    """

    name: str
    about: str
    read: Callable[[Seen], Terms]
    age_s: Callable[[Seen], float | None] = lambda _: None
    drained: bool = False


def atom_or_text(name: str | None) -> str:
    """A name as a term: an atom where it can be one, a string where not (ids may begin with a digit or hold a dash)."""
    if name is None:
        return "none"
    return name if name.isidentifier() and name[0].islower() else f'"{name}"'


def _base_age_s(seen: Seen) -> float | None:
    return seen.at_s - seen.view.base.at_s if seen.view.base else None


def _view_age_s(seen: Seen) -> float | None:
    return seen.at_s - seen.view.at_s


def _battery(seen: Seen) -> Terms:
    return [f"battery({seen.battery.word})"] if seen.battery.ratio is not None else []


def _line(seen: Seen) -> Terms:
    return [f"line({seen.view.line})"]


def _post_point(seen: Seen) -> Terms:
    where = seen.where
    return [f"postPoint({where.rests_at},{where.previous or 'unknown'})"] if where.rests_at else []


def _direction(seen: Seen) -> Terms:
    where = seen.where
    if where.destination is None:
        return ["direction(unknown,unknown)"]
    return [f"direction({where.destination},{where.way})"] if where.way else []


def _docked(seen: Seen) -> Terms:
    return ["docked"] if seen.view.base and seen.view.base.docked else []


def _charging(seen: Seen) -> Terms:
    return ["charging_dock"] if seen.view.base and seen.view.base.charging else []


def _at(seen: Seen) -> Terms:
    return (f"at({place})" for place in (seen.where.at, seen.where.bay_of) if place)


def _home(seen: Seen) -> Terms:
    return [f"home({seen.home})"] if seen.home else []


def _stops(seen: Seen) -> Terms:
    for number, stop in enumerate(seen.held.mission.stops if seen.held.mission else ()):
        order = atom_or_text(stop.order_id)
        yield f"stop({number},{atom_or_text(stop.id)},{stop.post},{stop.action},{order},{stop.wait_limit_s:g})"


def _fill(seen: Seen) -> Terms:
    for stop in seen.held.mission.stops if seen.held.mission else ():
        if stop.until_ratio is not None:
            is_reached = seen.battery.has(stop.until_ratio)
            yield f"fill({atom_or_text(stop.id)},{'reached' if is_reached else 'wanted'})"


def _mission(seen: Seen) -> Terms:
    mission = seen.held.mission
    return [f"mission({atom_or_text(mission.id)},{mission.update})"] if mission else []


PERCEPTS: Final = (
    Percept("battery", "battery(low|ok|full), with hysteresis", _battery, _base_age_s, drained=True),
    Percept(
        "weak",
        "less charge than work is begun with (setting battery.start_ratio)",
        lambda s: ["weak"] if s.battery.weak else [],
        _base_age_s,
    ),
    Percept(
        "recharging",
        "the battery was low and is not full again yet; remembered through a power cut",
        lambda s: ["recharging"] if s.held.recharging else [],
    ),
    Percept("line", "line(center|left|right|across|lost)", _line, _view_age_s, drained=True),
    Percept(
        "postPoint",
        "postPoint(Current, Previous): the robot has reached a post, until it rolls on",
        _post_point,
        drained=True,
    ),
    Percept("direction", "direction(Destination, forward|left|right|behind|arrived)", _direction, drained=True),
    Percept("docked", "the charging contacts of a dock are under power", _docked, _base_age_s),
    Percept("charging_dock", "the dock is charging the battery", _charging, _base_age_s),
    Percept(
        "at",
        "at(Post): it stands at this post, until it leaves along the line; in a bay, both at the bay and at its post",
        _at,
    ),
    Percept(
        "crossing",
        "crossing(Post): it is on a post that has bays, where others drive: no place to stand",
        lambda s: [f"crossing({s.where.crossing})"] if s.where.crossing else [],
    ),
    Percept(
        "dock_bay",
        "dock_bay(Post, Bay): the bay of this post that has the dock",
        lambda s: (f"dock_bay({post},{bay})" for post, bay in s.dock_bays.items()),
    ),
    Percept(
        "moved",
        "moved(Post): a person has moved it, and it found itself at this post; until noted_move",
        lambda s: [f"moved({s.where.moved})"] if s.where.moved else [],
    ),
    Percept(
        "astray",
        "astray(Post): it met the wrong line, and drives towards this post; until it has turned round",
        lambda s: [f"astray({s.where.astray})"] if s.where.astray else [],
    ),
    Percept(
        "doubted",
        "doubted(Post): it was switched off just before this post and may have passed it, or it turned back near to it "
        "and may have passed its marker, or on its crossing and may look anywhere; until a marker, a dock, its base or "
        "a person who lifts it tells",
        lambda s: [f"doubted({s.where.doubted})"] if s.where.doubted else [],
    ),
    Percept(
        "beside_dock",
        "it was switched off on its way into a dock or out of it, and stands beside the line",
        lambda s: ["beside_dock"] if s.where.beside_dock else [],
    ),
    Percept(
        "closed",
        "closed(Corridor): it turned back in there; no way leads through it for a while",
        lambda s: (f"closed({atom_or_text(name)})" for name in sorted(s.where.closed)),
    ),
    Percept(
        "detour",
        "detour(Post): it goes to this place first, to let others pass or to find the network; until it has gone. A "
        "post with bays is passed, and not perceived here",
        lambda s: [f"detour({s.where.detour})"] if s.where.detour else [],
    ),
    Percept("fault", "fault(Name): a fault of the reflex table", lambda s: (f"fault({f})" for f in s.view.faults)),
    Percept(
        "manoeuvring",
        "it turns, looks for the line or comes out of a dock: half way it would stand beside the line",
        lambda s: ["manoeuvring"] if s.view.motion in MANOEUVRES else [],
    ),
    Percept(
        "handing_over",
        "mail has just changed hands: people put it in or take it out",
        lambda s: ["handing_over"] if s.handing_over else [],
    ),
    Percept(
        "halted",
        "a fault keeps the wheels still until a person has seen to it",
        lambda s: ["halted"] if s.halting else [],
    ),
    Percept(
        "revoked",
        "its corridors were given to others, until it knows where it is; remembered through a power cut",
        lambda s: ["revoked"] if s.held.revoked else [],
    ),
    Percept(
        "unsure",
        "it was switched off for long with corridors granted; until the service has had time to say whose they are",
        lambda s: ["unsure"] if s.unsure else [],
    ),
    Percept("mission", "mission(Id, Update): what is to be done", _mission),
    Percept("stop", "stop(Number, Id, Post, Action, Order, WaitLimit_s): one of its stops", _stops),
    Percept(
        "fill",
        "fill(Stop, wanted|reached): at this stop it charges, until it has what is asked for or gets no fuller",
        _fill,
    ),
    Percept(
        "next_stop",
        "next_stop(Number): the first that is not done; remembered through a power cut",
        lambda s: [f"next_stop({s.held.next_stop})"] if s.held.mission else [],
    ),
    Percept(
        "carrying",
        "carrying(Order): its mail is aboard",
        lambda s: (f"carrying({atom_or_text(order)})" for order in s.held.cargo),
    ),
    Percept(
        "cancelled",
        "cancelled(Order): it is not to be served any more",
        lambda s: (f"cancelled({atom_or_text(order)})" for order in s.held.cancelled),
    ),
    Percept("paused", "the server asked to wait at the next post", lambda s: ["paused"] if s.held.paused else []),
    Percept("home", "home(Place): where it rests: the bay or the post of its own dock, or a bay without one", _home),
    Percept("dockless", "there is no dock at its home", lambda s: ["dockless"] if s.dockless else []),
    Percept(
        "nearest_dock",
        "nearest_dock(Post): by the map, from where it was last seen; none where no way to a dock is open",
        lambda s: [f"nearest_dock({s.nearest_dock})"] if s.nearest_dock else [],
    ),
    Percept("watch", "watch(N): changes every half minute, for watchdogs", lambda s: [f"watch({s.watch})"]),
)


def perceive(seen: Seen, mode: PerceptMode, age_limit_s: float) -> frozenset[str]:
    """The literals to show to the mind now. What has not been renewed for `age_limit_s` is not believed any more."""
    rows = [row for row in PERCEPTS if row.drained or mode is PerceptMode.LATEST]
    return frozenset(term for row in rows if _is_fresh(row, seen, age_limit_s) for term in row.read(seen))


def _is_fresh(row: Percept, seen: Seen, age_limit_s: float) -> bool:
    age_s = row.age_s(seen)
    return age_s is None or age_s <= age_limit_s
