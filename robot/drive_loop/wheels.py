"""The base as the loop commands it: who is master of the wheels, and what they may do."""

from robot.drive_loop.speaker import Speaker
from robot.drivers.interfaces import Base, BaseState, Mode, WheelSpeeds
from robot.skills.interfaces import BaseRequest, Play, SeekDock, SetMode, ShowLights
from robot.skills.tunes import BUMPED

OFF_DOCK_S = 2.0
"""Contacts bounce: only after so long without power is the robot off its dock."""


class Wheels:
    """Owns the mode. `state` in every call: the newest frame of the base, None before the first."""

    def __init__(self, base: Base, now: float) -> None:
        self._base, self._speaker = base, Speaker(base)
        self._mode = Mode.PASSIVE
        self._docked_s = now

    @property
    def own(self) -> bool:
        """False while they are the firmware's."""
        return self._mode is not Mode.PASSIVE

    def request(self, request: BaseRequest, now: float) -> None:
        match request:
            case SetMode(mode):
                self._mode = mode
                self._base.set_mode(mode, now)
            case SeekDock():
                self._mode = Mode.PASSIVE
                self._base.seek_dock(now)
            case Play(notes):
                self._speaker.say(notes, now)
            case ShowLights(colour, brightness):
                self._base.show_lights(colour, brightness, now)

    def drive(self, speeds: WheelSpeeds, now: float) -> WheelSpeeds:
        """The speeds that were really sent."""
        if not self.own and not speeds.still:
            self.request(SetMode(Mode.SAFE), now)
        return self._base.drive(speeds, now)

    def take(self, state: BaseState | None, now: float) -> None:
        """From the firmware, which in Passive docks on, or cleans because a person pressed Clean."""
        if not self.own and state is not None:
            self.request(SetMode(Mode.SAFE), now)

    def rest(self, state: BaseState | None, held: bool, now: float) -> None:
        """No motion: Passive on the dock, or it would not charge; Safe elsewhere, or a button would start to clean.

        `held`: a fault holds the wheels; then the mode stays, but for Full, which on a dock ends the charge for good.
        """
        if state is None:
            self.not_at_rest(now)
        elif held:
            self.not_at_rest(now)
            if state.docked and self._mode is Mode.FULL:
                self.request(SetMode(Mode.SAFE), now)  # which the firmware turns into Passive there
        elif state.docked:
            self.not_at_rest(now)
            if self.own:
                self.request(SetMode(Mode.PASSIVE), now)
        elif self._mode is not Mode.SAFE and now - self._docked_s > OFF_DOCK_S:
            self.request(SetMode(Mode.SAFE), now)

    def not_at_rest(self, now: float) -> None:
        self._docked_s = now

    def beep(self, now: float) -> None:
        self._speaker.say(BUMPED, now)

    def sound(self, state: BaseState | None, now: float) -> None:
        """Every tick: what waits to be heard."""
        self._speaker.tick(state, now)
