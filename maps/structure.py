"""Conditions of a map file: names that are names, ends that exist, lengths that can be."""

import re
from collections import Counter
from collections.abc import Iterator

from maps.geometry import Point, distance_m
from maps.map_file import CorridorRow, MapFile
from maps.problem import Problem, error

# A post's name becomes an atom of the robot's AgentSpeak program, the content of its markers and part of URLs.
NAME = re.compile(r"[a-z][A-Za-z0-9_]*")
HANDOVER_CODE_PREFIX = "CM1:"
# A tape measure may differ from a drawing; a corridor shorter than the straight line by more than this is a mistake.
LENGTH_TOLERANCE_M = 0.01


def structure_problems(file: MapFile) -> Iterator[Problem]:
    """Everything that makes the file unusable; nothing when it is a map."""
    yield from _names(file)
    yield from _both_kinds_of_bays(file)
    yield from _twice(file)
    points = {post.name: Point(post.x_m, post.y_m) for post in file.post}
    for corridor in file.corridor:
        yield from _ends(corridor, points)


def _names(file: MapFile) -> Iterator[Problem]:
    for name in (file.name, *_place_names(file)):
        if name.upper().startswith(HANDOVER_CODE_PREFIX):
            said = f"{name!r} looks like a hand-over code, so a robot would never take its marker for a post"
            yield error("code_as_name", name, said, f"No name may begin with {HANDOVER_CODE_PREFIX}")
        elif not NAME.fullmatch(name):
            said = f"{name!r} is not a name that an agent program can use"
            yield error("bad_name", name, said, "Begin with a small letter; then letters, digits and underscores.")


def _place_names(file: MapFile) -> Iterator[str]:
    for post in file.post:
        yield post.name
        yield from post.bay_names()


def _both_kinds_of_bays(file: MapFile) -> Iterator[Problem]:
    for post in file.post:
        old = [key for key in ("bays", "homes", "dock") if getattr(post, key) is not None]
        if post.bay and old:
            said = f"it has bays on the floor, and {' and '.join(old)} from before there were such"
            yield error("bays_twice", post.name, said, "Keep the tables [[post.bay]]; a home or a dock is a bay.")


def _twice(file: MapFile) -> Iterator[Problem]:
    for name, times in Counter(_place_names(file)).items():
        if times > 1:
            said = f"{times} posts or bays have this name"
            yield error("post_twice", name, said, "Give each of them a name of its own.")
    tags = file.tags()
    for tag, times in Counter(tag for tag in tags.values() if tag is not None).items():
        if times > 1:
            posts = " and ".join(name for name, its in tags.items() if its == tag)
            said = f"{posts} have the same tag, since a post without a tag of its own has its place in the file"
            yield error("tag_twice", f"tag {tag}", said, "Give each of them a tag of its own.")
    for name, times in Counter(corridor.name for corridor in file.corridor).items():
        if times > 1:
            said = f"{times} corridors join these two posts"
            yield error("corridor_twice", name, said, "Keep one, or put a post into the other.")


def _ends(corridor: CorridorRow, points: dict[str, Point]) -> Iterator[Problem]:
    unknown = [end for end in corridor.ends if end not in points]
    for end in unknown:
        said = f"it ends at {end!r}, which is no post of this map"
        yield error("unknown_post", corridor.name, said, "Add the post or correct the name.")
    if unknown:
        return
    a, b = corridor.ends
    straight_m = distance_m(points[a], points[b])
    if a == b:
        yield error("corridor_to_itself", corridor.name, "both ends are the same post", "Name the other end.")
    elif straight_m < LENGTH_TOLERANCE_M:
        yield error("same_place", corridor.name, "its two posts stand in the same place", "Correct x_m and y_m.")
    elif corridor.length_m is not None and corridor.length_m < straight_m - LENGTH_TOLERANCE_M:
        said = f"it is {corridor.length_m:g} m long, shorter than the straight line of {straight_m:.2f} m"
        yield error("too_short", corridor.name, said, "Measure again, or leave length_m out.")
