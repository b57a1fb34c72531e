"""Scenarios drawn by a seed, for benchmarks: what a tunnel does to a robot, and nothing that no robot could bear.

No patch without network covers a dock (nothing could ever be ordered), people in the way go away after a while, and
marker dirt stays below what their error correction can bear in most frames. What is drawn never depends on how a
robot drives.
"""

from collections.abc import Collection, Sequence
from itertools import pairwise
from random import Random
from typing import Any, Final

from maps import CampusMap, Corridor, NoRoute, shortest_route
from robot.scenarios.campus import campus_of
from robot.scenarios.errors import ScenarioError
from robot.scenarios.places import along
from robot.scenarios.scenario import MapChoice, Scenario

WORLDS: Final = {
    "track": MapChoice(name="test_track"),
    "tunnels": MapChoice(name="carleton", corridors_m=(3.0, 10.0)),
}
LOW_BATTERY, TWO_ORDERS, FAULTY = 0.3, 0.15, 0.2
"""Shares of the missions: a battery that becomes low on the way, two letters aboard, one injected fault."""
DOCK_ROOM_M = 1.2
FAULTS: Final[tuple[dict[str, Any], ...]] = (
    {"switch": "camera_dead", "for_s": 4.0},
    {"switch": "frozen", "for_s": 1.5},
    {"switch": "drop_byte", "value": 0.01, "for_s": 20.0},
    {"switch": "flip_byte", "value": 0.005, "for_s": 20.0},
    {"switch": "dock_beams_off", "for_s": 30.0},
)


def drawn(world: str, seed: int) -> Scenario:
    """The scenario with this number. Raises ScenarioError for a world that is not in WORLDS."""
    if world not in WORLDS:
        raise ScenarioError("drawn", "world", f"there is no {world!r}", f"There are: {', '.join(WORLDS)}.")
    # What lies about bays has a stream of its own: the rest of a number stayed the same when maps got bays.
    random, of_bays = Random(f"{world}/{seed}"), Random(f"{world}/{seed}/bays")
    campus = campus_of(WORLDS[world])
    spurs = campus.track.corridors[len(campus.corridors) :]
    home = random.choice(campus.docks()).name
    orders = _orders(random, campus)
    way_m = _way_m(campus, home, orders)
    return Scenario.model_validate(
        {
            "title": f"{world}, drawn by {seed}",
            "seed": seed,
            "limit_s": 900 + 4 * way_m / 0.1,
            "map": WORLDS[world].model_dump(),
            "robot": [_robot(random, home)],
            "noise": _noise(random),
            "dirt": _dirt(random, campus.posts) | _dirt(of_bays, [spur.b for spur in spurs]),
            "dark": [
                *(_dark(random, campus.corridors) for _ in range(random.randrange(3))),
                *(_dark(of_bays, spurs) for _ in range(of_bays.randrange(2)) if spurs),
            ],
            "no_network": _patches(random, campus),
            "stander": [_stander(random, campus) for _ in range(random.choice((0, 0, 1, 1, 2)))],
            "walker": [_walker(random, campus) for _ in range(random.randrange(2))],
            "order": orders,
            **_trouble(random, way_m),
        }
    )


def _orders(random: Random, campus: CampusMap) -> list[dict[str, Any]]:
    orders = []
    for number in range(2 if random.random() < TWO_ORDERS else 1):
        origin, destination = random.sample(sorted(campus.posts), 2)
        orders.append(
            {
                "id": f"o{number + 1}",
                "from": origin,
                "to": destination,
                "together": "m",
                "at_s": 1.0,
                "wait_limit_s": 90.0,
                "sender": _person(random, gives=True),
                "recipient": _person(random, gives=False),
            }
        )
    return orders


def _person(random: Random, gives: bool) -> dict[str, Any]:
    comes = random.choices(("in_time", "late", "never"), (80, 13, 7))[0]
    shows = random.choices(("code", "wrong_first", "spot"), (85, 10, 5))[0]
    return {
        "comes": comes,
        "late_s": random.uniform(10.0, 60.0),
        "shows": shows if gives or shows != "spot" else "code",
    }


def _robot(random: Random, home: str) -> dict[str, Any]:
    """A small pack and a strong charger: a charge takes a minute, and a battery can become low on a way of minutes."""
    low = random.random() < LOW_BATTERY
    ratio = random.uniform(0.255, 0.28) if low else random.uniform(0.5, 1.0)
    return {
        "name": "r1",
        "start": f"dock:{home}",
        "home": home,
        "battery": ratio,
        "capacity_mah": 1500.0,
        "charger_ma": 60_000.0,
    }


def _noise(random: Random) -> dict[str, float]:
    return {
        "flip": random.uniform(0.0, 0.01),
        "edge_mm": random.uniform(0.0, 3.0),
        "gap_mm": random.choice((0.0, 10.0, 20.0)),
    }


def _dirt(random: Random, places: Collection[str]) -> dict[str, float]:
    return {place: random.uniform(0.0, 0.06) for place in places if random.random() < 0.3}


def _dark(random: Random, lines: Sequence[Corridor]) -> dict[str, Any]:
    return _circle(random, lines, 1.0) | {"darkness": random.uniform(0.2, 0.6)}


def _circle(random: Random, lines: Sequence[Corridor], radius_m: float) -> dict[str, Any]:
    """Somewhere on the tape."""
    at = along(random.choice(lines), random.random())
    return {"at": (at.x_m, at.y_m), "radius_m": random.uniform(0.4, radius_m)}


def _patches(random: Random, campus: CampusMap) -> list[dict[str, Any]]:
    circles = [_circle(random, campus.corridors, 1.5) for _ in range(random.randrange(3))]
    return [one for one in circles if not _covers_dock(one, campus)]


def _covers_dock(circle: dict[str, Any], campus: CampusMap) -> bool:
    (x_m, y_m), radius_m = circle["at"], circle["radius_m"]
    docks = [post.dock for post in campus.docks() if post.dock]
    return any(abs(dock.x_m - x_m) + abs(dock.y_m - y_m) < radius_m + DOCK_ROOM_M for dock in docks)


def _stander(random: Random, campus: CampusMap) -> dict[str, Any]:
    """Not within reach of a turn at a post: a person who stands there would have to be pushed aside."""
    return {
        "corridor": random.choice(campus.corridors).name,
        "along": random.uniform(0.35, 0.65),
        "leaves_after_s": random.uniform(3.0, 20.0),
    }


def _walker(random: Random, campus: CampusMap) -> dict[str, Any]:
    """Across the tape, at a walk."""
    x_m, y_m = along(random.choice(campus.corridors), random.uniform(0.3, 0.7))
    dx_m, dy_m = random.choice(((2.0, 0.0), (0.0, 2.0), (1.5, 1.5)))
    return {
        "path": ((x_m - dx_m, y_m - dy_m), (x_m + dx_m, y_m + dy_m)),
        "at_s": random.uniform(5.0, 120.0),
        "speed_m_s": random.uniform(0.5, 1.4),
    }


def _trouble(random: Random, way_m: float) -> dict[str, Any]:
    if random.random() >= FAULTY:
        return {}
    at_s = random.uniform(10.0, 10.0 + way_m / 0.15)
    if random.random() < 0.3:
        return {"deed": [{"do": "bump", "at_s": at_s}]}
    return {"fault": [random.choice(FAULTS) | {"at_s": at_s}]}


def _way_m(campus: CampusMap, home: str, orders: list[dict[str, Any]]) -> float:
    posts = [home, *(order["from"] for order in orders), *(order["to"] for order in orders), home]
    try:
        return sum(shortest_route(campus, a, b).length_m for a, b in pairwise(posts))
    except NoRoute as error:
        raise ScenarioError("drawn", "map", str(error)) from None
