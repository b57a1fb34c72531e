"""Posts whose marker could not be read when the robot was there last: people clean them."""

from collections.abc import Container
from typing import Final

from robot.mission.mission import MissionManager

FAULT: Final = "marker_unread"


class UnreadMarkers(Container[str]):
    """Empty when the robot is switched on."""

    def __init__(self, missions: MissionManager) -> None:
        self._posts: set[str] = set()
        self._missions = missions

    def __contains__(self, post: object) -> bool:
        return post in self._posts

    def note(self, post: str, unread: bool) -> None:
        """People are told of a marker that needs cleaning, and when all can be read again."""
        if unread:
            self._posts.add(post)
            reason = f"The marker of {post} cannot be read. The robot went there by the length of the way."
            self._missions.report_fault(FAULT, reason, post)
        else:
            self._posts.discard(post)
        if not self._posts:
            self._missions.report_fault(FAULT, "Every marker has been read again.", post, cleared=True)
