"""The campus as everybody else sees it: posts with markers and docks, and the corridors between them.

Units are metres and radians. x points east, y north; a heading is counter-clockwise from east. This is the only place
that turns a map file into something to work with; service, robot and simulator all read the same one.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from hashlib import sha256
from itertools import pairwise
from json import dumps, loads
from pathlib import Path
from typing import Any

from maps.errors import MapError, UnknownCorridor, UnknownPost
from maps.geometry import Point, heading_rad, moved, path_length_m, rounded
from maps.map_file import CorridorRow, MapFile, PoseRow, PostRow, load_map_file
from maps.structure import structure_problems

MARKER_SIZE_M = 0.08
# Where a marker stands unless the file says otherwise, as seen on arrival at the post: on the left, where
# the camera looks; before the post, so that the robot knows the distance left to roll; and clear of the line by more
# than the robot's radius (174 mm), so that a branch to the left stays free.
MARKER_BEFORE_POST_M = 0.30
MARKER_BESIDE_LINE_M = 0.35
FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Marker:
    """A QR code that says `post`, at (x_m, y_m); heading_rad is the way its printed face looks."""

    post: str
    x_m: float
    y_m: float
    heading_rad: float
    size_m: float = MARKER_SIZE_M


@dataclass(frozen=True)
class Dock:
    """Where the centre of a docked robot is, and the way that robot looks: into the dock."""

    x_m: float
    y_m: float
    heading_rad: float


@dataclass(frozen=True)
class Post:
    """A place where a robot can stop. `bays` is how many can stand there clear of the line; `homes` how many have their
    home place there, clear of the bays too, the dock among them; `tag`: see `maps.tags`.

    `network` False: no robot is heard there.
    """

    name: str
    title: str
    x_m: float
    y_m: float
    markers: tuple[Marker, ...] = ()
    dock: Dock | None = None
    bays: int = 1
    mailroom: bool = False
    tag: int | None = None
    network: bool = True
    homes: int = 0

    @property
    def point(self) -> Point:
        return Point(self.x_m, self.y_m)


@dataclass(frozen=True)
class Corridor:
    """The line between two posts. `tape` is where it lies, from a to b, both ends included; `network`: as of a post.

    `following_s`: robots may follow each other in it, so many seconds apart; None: it is for one robot at a time.
    """

    a: str
    b: str
    length_m: float
    assumed: bool
    tape: tuple[Point, ...]
    network: bool = True
    following_s: float | None = None

    @property
    def name(self) -> str:
        return corridor_name(self.a, self.b)

    def other(self, post: str) -> str:
        return {self.a: self.b, self.b: self.a}[post]

    def tape_from(self, post: str) -> tuple[Point, ...]:
        """The tape as a robot meets it that leaves `post`."""
        return self.tape if post == self.a else self.tape[::-1]

    def heading_leaving(self, post: str) -> float:
        """The way a robot looks that sets out from `post` along this corridor (a bend may change it later)."""
        return heading_rad(*self.tape_from(post)[:2])

    def heading_arriving(self, post: str) -> float:
        """The way a robot looks that arrives at `post` along this corridor."""
        return heading_rad(*self.tape_from(self.other(post))[-2:])


@dataclass(frozen=True)
class CampusMap:
    """`version` changes with any fact of the map and with nothing else, so that two sides can compare theirs."""

    name: str
    title: str
    posts: Mapping[str, Post]
    corridors: tuple[Corridor, ...]
    note: str = ""
    version: str = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "version", _fingerprint(self.name, self.posts.values(), self.corridors))

    def post(self, name: str) -> Post:
        """Raises UnknownPost, which says the nearest spelling."""
        try:
            return self.posts[name]
        except KeyError:
            raise UnknownPost(name, self.name, self.posts) from None

    def neighbours(self, name: str) -> tuple[tuple[Post, Corridor], ...]:
        """The posts one corridor away, in the order of the file."""
        self.post(name)
        return self._neighbours[name]

    @cached_property
    def _neighbours(self) -> Mapping[str, tuple[tuple[Post, Corridor], ...]]:
        return {
            name: tuple((self.posts[c.other(name)], c) for c in self.corridors if name in (c.a, c.b))
            for name in self.posts
        }

    def corridor(self, a: str, b: str) -> Corridor:
        """The corridor between two neighbouring posts, whichever way round."""
        for post in (a, b):
            self.post(post)
        return self.corridor_named(corridor_name(a, b))

    def corridor_named(self, name: str) -> Corridor:
        for corridor in self.corridors:
            if corridor.name == name:
                return corridor
        raise UnknownCorridor(name, self.name)

    def docks(self) -> tuple[Post, ...]:
        """The posts that have a charging station."""
        return tuple(post for post in self.posts.values() if post.dock)


def corridor_name(a: str, b: str) -> str:
    return "-".join(sorted((a, b)))


def read_map(path: Path | str) -> CampusMap:
    """Read one map file. Raises MapError: source, place, message, way out."""
    file = load_map_file(Path(path))
    for problem in structure_problems(file):
        raise MapError(str(path), problem.place, problem.sentence, problem.way_out)
    return build_map(file)


def builtin_map(name: str) -> CampusMap:
    """A map that ships with the product: `test_track` (the paper's Figure 5) or `carleton`."""
    return read_map(builtin_path(name))


def builtin_path(name: str) -> Path:
    known = sorted(file.stem for file in FOLDER.glob("*.toml"))
    if name not in known:
        raise MapError(name, "name", "no map of this name ships with Campus Mail", f"There are: {', '.join(known)}.")
    return FOLDER / f"{name}.toml"


def find_map(name_or_path: Path | str) -> CampusMap:
    """A built-in map by its name, any other by its file."""
    return read_map(map_path(name_or_path))


def map_path(name_or_path: Path | str) -> Path:
    """Where `find_map` looks: a bare word is a built-in map, everything else a file."""
    path = Path(name_or_path)
    is_bare_word = path.name == str(name_or_path) and not path.suffix
    return builtin_path(str(path)) if is_bare_word else path


def build_map(file: MapFile) -> CampusMap:
    """The map of a file in whose structure nothing is wrong."""
    points = {post.name: Point(post.x_m, post.y_m) for post in file.post}
    corridors = tuple(_corridor(row, points) for row in file.corridor)
    posts = {row.name: _post(row, corridors, tag) for row, tag in zip(file.post, file.tags(), strict=True)}
    return CampusMap(file.name, file.title, posts, corridors, file.note.strip())


def _corridor(row: CorridorRow, points: Mapping[str, Point]) -> Corridor:
    a, b = row.ends
    path = (points[a], *(Point(*corner) for corner in row.via), points[b])
    # Two of the same point in a row have no direction between them.
    path = (path[0], *(there for here, there in pairwise(path) if here != there))
    tape = rounded(path, row.bend_radius_m)
    return Corridor(a, b, row.length_m or path_length_m(tape), row.assumed, tape, row.network, row.following_s)


def _post(row: PostRow, corridors: tuple[Corridor, ...], tag: int | None) -> Post:
    dock = Dock(row.dock.x_m, row.dock.y_m, math.radians(row.dock.heading_deg)) if row.dock else None
    markers = _standard_markers(row, dock, corridors) if row.markers is None else _own_markers(row.name, row.markers)
    title = row.title or row.name
    homes = int(dock is not None) if row.homes is None else row.homes
    return Post(row.name, title, row.x_m, row.y_m, markers, dock, row.bays, row.mailroom, tag, row.network, homes)


def _own_markers(post: str, rows: tuple[PoseRow, ...]) -> tuple[Marker, ...]:
    return tuple(Marker(post, row.x_m, row.y_m, math.radians(row.heading_deg)) for row in rows)


def _standard_markers(row: PostRow, dock: Dock | None, corridors: tuple[Corridor, ...]) -> tuple[Marker, ...]:
    """One beside every approach and one beside a docked robot, so that it knows where it is when it wakes up."""
    here = Point(row.x_m, row.y_m)
    arrivals = [c.heading_arriving(row.name) for c in corridors if row.name in (c.a, c.b)]
    beside_line = [_marker(row.name, here, heading, MARKER_BEFORE_POST_M) for heading in arrivals]
    beside_dock = [_marker(row.name, Point(dock.x_m, dock.y_m), dock.heading_rad, 0.0)] if dock else []
    return (*beside_line, *beside_dock)


def _marker(post: str, seen_from: Point, robot_heading_rad: float, before_m: float) -> Marker:
    """A marker on the left of a robot, its face turned towards the camera."""
    x_m, y_m = moved(seen_from, robot_heading_rad, -before_m, MARKER_BESIDE_LINE_M)
    return Marker(post, x_m, y_m, heading_rad(Point(x_m, y_m), moved(seen_from, robot_heading_rad, -before_m)))


def _fingerprint(name: str, posts: Iterable[Post], corridors: Iterable[Corridor]) -> str:
    """Twelve hex digits of the facts, rounded to a micrometre: two machines may differ in the last bit of a sine."""
    facts = {"name": name, "posts": [_facts(post) for post in posts], "corridors": [_facts(c) for c in corridors]}
    # Adding 0.0 turns a negative zero into a plain one.
    rounded_facts = loads(dumps(facts), parse_float=lambda digits: round(float(digits), 6) + 0.0)
    return sha256(dumps(rounded_facts, sort_keys=True).encode()).hexdigest()[:12]


def _facts(place: Post | Corridor) -> dict[str, Any]:
    """Maps that say nothing of what was added later keep their version."""
    usual: dict[str, Any] = {"network": True, "following_s": None}
    if isinstance(place, Post):
        usual["homes"] = int(place.dock is not None)
    return {key: value for key, value in asdict(place).items() if key not in usual or value != usual[key]}
