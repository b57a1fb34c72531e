"""The campus as everybody else sees it: posts with markers and docks, and the corridors between them.

Units are metres and radians. x points east, y north; a heading is counter-clockwise from east. This is the only place
that turns a map file into something to work with; service, robot and simulator all read the same one.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from itertools import pairwise
from json import dumps, loads
from pathlib import Path
from typing import Any

from maps.bays import (
    MARKER_BEFORE_CROSSING_M,
    MARKER_BEFORE_PLACE_M,
    Bay,
    Dock,
    Marker,
    bays_of,
    marker,
    own_markers,
)
from maps.errors import MapError, UnknownCorridor, UnknownPost
from maps.geometry import Point, heading_rad, path_length_m, rounded
from maps.map_file import CorridorRow, MapFile, PostRow, load_map_file
from maps.structure import structure_problems

FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Post:
    """An address: where lines meet, with `spurs`, the bays on the floor in which robots stand.

    `bays` is how many robots can stand there clear of the line; `homes` how many have their home place there, clear of
    the bays too, the dock among them; `tag`: see `maps.tags`. `network` False: no robot is heard there. `bay_of`: on a
    track, this is a bay of that post.
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
    spurs: tuple[Bay, ...] = ()
    bay_of: str | None = None

    @property
    def point(self) -> Point:
        return Point(self.x_m, self.y_m)

    @property
    def is_for_passing(self) -> bool:
        """On a track: it is a bay, and kept neither for one robot nor for robots that charge."""
        return self.bay_of is not None and not self.homes and self.dock is None

    @property
    def is_lent(self) -> bool:
        """On a track: a bay with a dock that is no robot's home: it is lent to the robots that charge there."""
        return self.bay_of is not None and not self.homes and self.dock is not None


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

    @cached_property
    def track(self) -> "CampusMap":
        """The lines as a robot follows them: each bay is a place like a post, each spur a corridor that leads there.

        Its posts have no dock, their bays do. The same map where no post has a bay on the floor.
        """
        if not any(post.spurs for post in self.posts.values()):
            return self
        places = {place.name: place for post in self.posts.values() for place in _places(post)}
        spurs = tuple(_spur(post, bay) for post in self.posts.values() for bay in post.spurs)
        track = CampusMap(self.name, self.title, places, (*self.corridors, *spurs), self.note)
        object.__setattr__(track, "version", self.version)  # it says nothing that the map does not
        return track

    def address_of(self, place: str) -> str:
        """The post of a bay; any other name as it is."""
        return self._addresses.get(place, place)

    @cached_property
    def _addresses(self) -> Mapping[str, str]:
        return {place.name: place.bay_of for place in self.track.posts.values() if place.bay_of}

    def bays_of(self, post: str) -> tuple[Post, ...]:
        """On a track: the bays of a post, in the order of the file; none where robots stand on the post itself."""
        return self._bays.get(post, ())

    def home_at(self, name: str | None) -> str | None:
        """On a track: the home of that name or at that post; without a name the first dock of the map. None: none."""
        if name is None:
            return next((place.name for place in self.docks() if not place.is_lent), None)
        return next((place.name for place in self.homes if name in (place.name, place.bay_of)), None)

    @property
    def homes(self) -> tuple[Post, ...]:
        """On a track: where robots can be at home: in bays that are homes, and in docks where there are no bays."""
        return tuple(place for place in self.posts.values() if (place.homes if place.bay_of else place.dock))

    @property
    def home_bays(self) -> tuple[Post, ...]:
        """On a track: the bays that are homes, those with a dock first."""
        homes = [place for place in self.posts.values() if place.bay_of and place.homes]
        return tuple(sorted(homes, key=lambda place: place.dock is None))

    @cached_property
    def _bays(self) -> Mapping[str, tuple[Post, ...]]:
        bays: dict[str, tuple[Post, ...]] = {}
        for place in self.posts.values():
            if place.bay_of:
                bays[place.bay_of] = (*bays.get(place.bay_of, ()), place)
        return bays

    def docks_to_share(self) -> tuple[str, ...]:
        """The posts with a dock in which the map gives no robot its home; every dock of a map without bays."""
        return tuple(post.name for post in self.docks() if any(bay.is_lent for bay in post.spurs) or not post.spurs)

    def docks(self) -> tuple[Post, ...]:
        """The posts that have a charging station."""
        return tuple(post for post in self.posts.values() if post.dock)

    @cached_property
    def dock_bays(self) -> Mapping[str, str]:
        """On a track: the bay with the dock of each post that has one."""
        return {place.bay_of: place.name for place in self.docks() if place.bay_of}


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
    tags = file.tags()
    posts = {row.name: _post(row, corridors, tags) for row in file.post}
    return CampusMap(file.name, file.title, posts, corridors, file.note.strip())


def _corridor(row: CorridorRow, points: Mapping[str, Point]) -> Corridor:
    a, b = row.ends
    path = (points[a], *(Point(*corner) for corner in row.via), points[b])
    # Two of the same point in a row have no direction between them.
    path = (path[0], *(there for here, there in pairwise(path) if here != there))
    tape = rounded(path, row.bend_radius_m)
    return Corridor(a, b, row.length_m or path_length_m(tape), row.assumed, tape, row.network, row.following_s)


def _post(row: PostRow, corridors: tuple[Corridor, ...], tags: Mapping[str, int | None]) -> Post:
    spurs = bays_of(row, tags)
    dock = Dock(row.dock.x_m, row.dock.y_m, math.radians(row.dock.heading_deg)) if row.dock else None
    arrivals = [c.heading_arriving(row.name) for c in corridors if row.name in (c.a, c.b)]
    arrivals += [bay.bearing_rad + math.pi for bay in spurs]
    markers = (
        _standard_markers(row, dock, arrivals, spurs) if row.markers is None else own_markers(row.name, row.markers)
    )
    if spurs:
        homes, bays = sum(bay.home for bay in spurs), sum(bay.is_for_passing for bay in spurs)
        dock = next((bay.dock for bay in spurs if bay.dock), None)
    else:
        homes, bays = int(dock is not None) if row.homes is None else row.homes, 1 if row.bays is None else row.bays
    title, tag = row.title or row.name, tags[row.name]
    return Post(row.name, title, row.x_m, row.y_m, markers, dock, bays, row.mailroom, tag, row.network, homes, spurs)


def _standard_markers(
    row: PostRow, dock: Dock | None, arrivals: Sequence[float], spurs: tuple[Bay, ...]
) -> tuple[Marker, ...]:
    """One beside every approach and one beside a docked robot, so that it knows where it is when it wakes up."""
    here = Point(row.x_m, row.y_m)
    before_m = MARKER_BEFORE_CROSSING_M if spurs else MARKER_BEFORE_PLACE_M
    beside_line = [marker(row.name, here, heading, before_m) for heading in arrivals]
    beside_dock = [marker(row.name, Point(dock.x_m, dock.y_m), dock.heading_rad, 0.0)] if dock else []
    return (*beside_line, *beside_dock)


def _places(post: Post) -> Iterator[Post]:
    """The post without what its bays have, and each bay as a post."""
    yield replace(post, dock=None, bays=0, homes=0, spurs=()) if post.spurs else post
    for number, bay in enumerate(post.spurs, start=1):
        title = f"{post.title}, bay {number}"
        place = Post(bay.name, title, bay.x_m, bay.y_m, bay.markers, bay.dock, tag=bay.tag, network=post.network)
        yield replace(place, homes=int(bay.home), bay_of=post.name)


def _spur(post: Post, bay: Bay) -> Corridor:
    return Corridor(post.name, bay.name, bay.length_m, False, (post.point, bay.point), post.network)


def _fingerprint(name: str, posts: Iterable[Post], corridors: Iterable[Corridor]) -> str:
    """Twelve hex digits of the facts, rounded to a micrometre: two machines may differ in the last bit of a sine."""
    facts = {"name": name, "posts": [_facts(post) for post in posts], "corridors": [_facts(c) for c in corridors]}
    # Adding 0.0 turns a negative zero into a plain one.
    rounded_facts = loads(dumps(facts), parse_float=lambda digits: round(float(digits), 6) + 0.0)
    return sha256(dumps(rounded_facts, sort_keys=True).encode()).hexdigest()[:12]


def _facts(place: Post | Corridor) -> dict[str, Any]:
    """Maps that say nothing of what was added later keep their version."""
    usual: dict[str, Any] = {"network": True, "following_s": None, "spurs": (), "bay_of": None}
    if isinstance(place, Post):
        usual["homes"] = int(place.dock is not None)
    return {key: value for key, value in asdict(place).items() if key not in usual or value != usual[key]}
