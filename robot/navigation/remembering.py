"""What a robot that is switched on again knows of its place."""

from maps import CampusMap
from protocol import parts

from .position import Position


def remembered(campus: CampusMap, position: parts.Position) -> Position:
    """Where the robot was when it was switched off. `towards` was written down before it left or turned."""
    post, previous, towards = position.post, position.previous, position.towards
    if post is None or post not in campus.posts:
        return Position()
    beside = {neighbour.name: corridor for neighbour, corridor in campus.neighbours(post)}
    if towards:
        facing_rad = beside[towards].heading_leaving(post) if towards in beside else None
        return Position(post, previous, facing_rad, has_left=True)
    facing_rad = beside[previous].heading_arriving(post) if previous in beside else None
    return Position(post, previous, facing_rad, post_at_mm=0.0)
