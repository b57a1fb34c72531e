"""Into the dock and out of it. In, the firmware drives by the dock's infrared; out, it does not, so we do."""

import math

from ..drivers.interfaces import STOP, BodyShape, Mode, WheelSpeeds
from .find_line import over_line
from .interfaces import Done, Failed, Running, SeekDock, SetMode, View
from .script import Part, Script, Scripted, roll, stand, turn_by

CHARGING_S = 3.0
"""Contacts may bounce: only charging for so long is docked."""
CONTACT_LOST_S = 1.0
ATTEMPT_S = 60.0
IDLE_S = 10.0
"""A firmware that has not moved for so long has given up."""
BACK_MM_S = 100.0
RETRY_BACK_MM = 250.0
UNDOCK_MM = 300.0
TO_LINE_MM = 500.0
TO_LINE_MM_S = 70.0
MODE_S = 3.0


class Dock(Scripted):
    """Done when the dock has charged for 3 s; no_dock after the last try."""

    name = "dock"
    on_timeout = "no_dock"

    def __init__(self, tries: int = 3, limit_s: float = 300.0) -> None:
        self._tries = tries
        self.limit_s = limit_s

    def script(self, view: View) -> Script:
        """Seek, and on failure back off a little and seek again."""
        for attempt in range(self._tries):
            if attempt:
                view = yield from self._back_off(view)
            view = yield from self._seek(view)
            if _charging(view):
                return Done()
        view = yield from self._back_off(view)
        return Failed("no_dock")

    def _seek(self, view: View) -> Part:
        began_s = moved_s = view.at_s
        charging_since_s: float | None = None
        charging_s = view.at_s
        odometry = view.odometry
        view = yield Running(None, () if _charging(view) else (SeekDock(),))
        while view.at_s - began_s < ATTEMPT_S:
            if view.odometry.travelled_mm != odometry.travelled_mm:
                odometry, moved_s = view.odometry, view.at_s
            if _charging(view):
                charging_s = moved_s = view.at_s
                charging_since_s = view.at_s if charging_since_s is None else charging_since_s
                if view.at_s - charging_since_s >= CHARGING_S:
                    return view
            elif view.at_s - charging_s > CONTACT_LOST_S:
                charging_since_s = None
                if view.at_s - moved_s > IDLE_S:
                    return view
            view = yield Running(None)
        return view

    def _back_off(self, view: View) -> Part:
        view = yield Running(STOP, (SetMode(Mode.SAFE),))
        return (yield from roll(view, RETRY_BACK_MM, WheelSpeeds(-BACK_MM_S, -BACK_MM_S)))


class Undock(Scripted):
    """Back off 300 mm in Full (Safe ends on a powered dock), turn round, and go on to the line."""

    name = "undock"

    def __init__(self, shape: BodyShape | None = None, limit_s: float = 60.0) -> None:
        self._shape = shape or BodyShape()
        self.limit_s = limit_s

    def script(self, view: View) -> Script:
        """not_docked when it is not on a dock, line_lost when there is none behind it."""
        if view.base is None or not view.base.docked:
            return Failed("not_docked")
        view = yield Running(STOP, (SetMode(Mode.FULL),))
        view = yield from _until_mode(view, Mode.FULL)
        view = yield from roll(view, UNDOCK_MM, WheelSpeeds(-BACK_MM_S, -BACK_MM_S))
        view = yield Running(STOP, (SetMode(Mode.SAFE),))
        view = yield from _until_mode(view, Mode.SAFE)
        view = yield from turn_by(view, math.pi, 80.0, self._shape)
        # The tape ends at the post, some way before the dock.
        view = yield from roll(view, TO_LINE_MM, WheelSpeeds(TO_LINE_MM_S, TO_LINE_MM_S), over_line)
        return Done() if over_line(view) else Failed("line_lost")


def _charging(view: View) -> bool:
    return view.base is not None and view.base.docked and view.base.charging


def _until_mode(view: View, mode: Mode) -> Part:
    """Wait until the base says so; an odd firmware never does, so not for ever."""
    until_s = view.at_s + MODE_S
    while view.at_s < until_s and view.base is not None and view.base.mode not in (mode, Mode.UNKNOWN):
        view = yield Running(STOP)
    return (yield from stand(view, 0.05))
