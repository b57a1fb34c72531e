"""One way from place to place, in parts: what a body is in meanwhile, and how long each part takes."""

from dataclasses import dataclass
from random import Random

from benchmarks.fleet_simulation.durations import Taking
from benchmarks.fleet_simulation.judge import bay, corridor, crossing
from maps import CampusMap
from protocol.parts import Leg


@dataclass
class Part:
    """`left_s`: so much of it is left to drive."""

    places: tuple[str, ...]
    left_s: float


def is_spur(track: CampusMap, leg: Leg) -> bool:
    return any(track.post(place).bay_of for place in (leg.from_post, leg.to_post))


def place_of(track: CampusMap, post: str) -> str:
    """Of a body that stands there."""
    return bay(post) if track.post(post).bay_of else crossing(post)


def parts_of(track: CampusMap, taking: Taking, leg: Leg, rng: Random) -> list[Part]:
    """A spur is one part. A corridor has four: over the crossing into it, on to where it asks for what comes after it,
    to where it waits, and on to the crossing at its end."""
    table = taking.table
    if is_spur(track, leg):
        spread = table.out_of_bay if track.post(leg.from_post).bay_of else table.into_bay
        return [Part((place_of(track, leg.from_post), place_of(track, leg.to_post)), spread.draw_s(rng))]
    inside = corridor(leg)
    into_s, to_crossing_s = table.into_corridor.draw_s(rng), table.to_crossing.draw_s(rng)
    return [
        Part((crossing(leg.from_post), inside), into_s),
        *_inside(leg, taking, rng, into_s + to_crossing_s),
        Part((inside, crossing(leg.to_post)), to_crossing_s),
    ]


def parts_back(taking: Taking, leg: Leg, rng: Random) -> list[Part]:
    """Of one that has turned round inside and goes this way now."""
    to_crossing_s, turned_s = taking.table.to_crossing.draw_s(rng), taking.table.turn_back.draw_s(rng)
    first, *rest = _inside(leg, taking, rng, 0.0)
    first.left_s += turned_s
    return [first, *rest, Part((corridor(leg), crossing(leg.to_post)), to_crossing_s)]


def _inside(leg: Leg, taking: Taking, rng: Random, else_s: float) -> list[Part]:
    ask_s = taking.table.asks_before_m / taking.table.speed_m_s
    far_s = max(0.0, taking.drive_s(leg, rng) - else_s - ask_s)
    return [Part((corridor(leg),), far_s), Part((corridor(leg),), ask_s)]
