"""Which AprilTag 36h11 stands for which post or bay: the one table that sheets, robot and simulator use.

A post's number is its key `tag` in the map file, or else its place there, counted from 0; bays are counted down from
the last tag. What is added at the end of a file leaves all other printed sheets as they are; an editor who sorts a file
pins the numbers with `tag`.
"""

from maps.campus_map import CampusMap

TAG_SIZE_MM = 40.0
"""The black square; at 0.7 m it is still 32 pixels wide, 4 for each of its 8 cells."""


def tag_numbers(campus: CampusMap) -> dict[int, str]:
    """Number → name of the post or bay."""
    return {place.tag: place.name for place in campus.track.posts.values() if place.tag is not None}
