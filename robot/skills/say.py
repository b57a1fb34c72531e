"""A tune, and the colour of the light."""

from typing import ClassVar

from robot.core.errors import UnknownSkill
from robot.skills.interfaces import Done, Play, ShowLights, Step, View
from robot.skills.tunes import TUNES


class Say:
    """Done at once: the base plays by itself."""

    name: ClassVar[str] = "say"
    moves: ClassVar[bool] = False
    limit_s: ClassVar[float] = 5.0
    on_timeout: ClassVar[str] = "timeout"

    def __init__(self, tune: str = "arrived", colour: float = 0.0, brightness: float = 1.0) -> None:
        """`tune` is one of tunes.TUNES, else UnknownSkill. Colour 0 green to 1 red, brightness 0 to 1."""
        if tune not in TUNES:
            raise UnknownSkill(tune, tuple(TUNES))
        self._notes, self._light = TUNES[tune], ShowLights(colour, brightness)

    def start(self, view: View, now: float) -> None:
        """Nothing to prepare."""

    def step(self, view: View, now: float) -> Step:
        """See `interfaces.Skill.step`."""
        return Done(requests=(Play(self._notes), self._light))
