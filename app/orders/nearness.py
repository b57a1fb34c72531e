"""Nearness of the robot that fetches mail to its sender, by the posts that it passes."""

import math
from typing import Final

from maps.ways import Ways

NEAR_S: Final = 180.0
"""The sender is told that the robot is near when it is one post away, or this long at most."""


def is_near(ways: Ways, post: str | None, to_post: str, speed_m_s: float) -> bool:
    """For a robot that was at `post` just now: it is a single corridor away, or so close that it soon arrives.

    After the last post on its way nothing is heard of it before it is there. One whose place is not known counts as
    near: people are told too early rather than not at all.
    """
    length_m = ways.length_m(post, to_post)
    if post is None or math.isinf(length_m) or any(one.name == to_post for one, _ in ways.campus.neighbours(post)):
        return True
    return length_m <= NEAR_S * speed_m_s
