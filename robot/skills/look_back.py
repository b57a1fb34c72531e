"""Going back a little along the corridor that the robot came by, until it reads the marker of the post ahead."""

from robot.drivers.interfaces import STOP, WheelSpeeds
from robot.localization.approach import is_aslant
from robot.skills.interfaces import Done, Failed, Running, View
from robot.skills.script import Script, Scripted, roll, stand

BACK_MM_S = 50.0
"""A marker is in sight for 400 mm: at this speed for 8 s, and nothing behind is hit hard."""
LOOKS_FOR_S = 1.5
"""It may be in sight from where the robot stands."""


class LookBack(Scripted):
    """Done when the marker is read; no_marker, timeout."""

    name = "look_back"

    def __init__(self, post: str | None, most_mm: float) -> None:
        """`post`: whose marker; None: there is nothing to look for. `most_mm`: how far back at most."""
        self._post, self._most_mm = post, most_mm

    def script(self, view: View) -> Script:
        """First look from where it stands."""
        begun_s, until_s = view.at_s, view.at_s + LOOKS_FOR_S

        def reads(view: View) -> bool:
            post = view.post
            return post is not None and post.at_s >= begun_s and post.text == self._post and not is_aslant(post)

        while view.at_s < until_s and not reads(view):
            view = yield Running(STOP)
        if not reads(view):
            view = yield from roll(view, self._most_mm, WheelSpeeds(-BACK_MM_S, -BACK_MM_S), reads)
        view = yield from stand(view)
        return Done() if self._post is None or reads(view) else Failed("no_marker")
