"""Reports of the byte machine: answers to queries, and the stream.

Source [S] unless marked [A] (assumption).
"""

from robot.simulated.base.commands import Mode
from robot.simulated.base.packets import Layout, Readings, stream_frame
from robot.simulated.base.songs import SongBook
from robot.simulated.faults import Faults

BUTTON_S = 1 / 6


class Reports:
    """`readings` is shared with the world, which keeps the physical packets in it up to date."""

    def __init__(self, readings: Readings, faults: Faults) -> None:
        self.readings = readings
        self._faults = faults
        self._stream: Layout | None = None
        self._streaming = False
        self._buttons_until_s = 0.0

    def answer(self, ids: bytes, mode: Mode, songs: SongBook, now: float) -> bytes:
        """Only data, one packet after the other."""
        layout = Layout(ids, tagged=False)
        return b"" if self._hides(layout) else self._encode(layout, mode, songs, now)

    def frame(self, mode: Mode, songs: SongBook, now: float) -> bytes:
        """The next frame of the stream; nothing while there is none."""
        if not self._streaming or self._stream is None or self._hides(self._stream):
            return b""
        return stream_frame(self._encode(self._stream, mode, songs, now))

    def _hides(self, layout: Layout) -> bool:
        return layout.tells_mode and self._faults.mode_silent

    def stream(self, ids: bytes) -> None:
        self._stream = Layout(ids, tagged=True)
        self._streaming = bool(self._stream.ids)

    def pause(self, on: bool) -> None:
        self._streaming = not on and self._stream is not None

    def forget_stream(self) -> None:
        self._stream, self._streaming = None, False

    def press(self, buttons: int, now: float) -> None:
        """They are let go by themselves."""
        self.readings.buttons = buttons
        self._buttons_until_s = now + BUTTON_S

    def _encode(self, layout: Layout, mode: Mode, songs: SongBook, now: float) -> bytes:
        told = self.readings
        told.oi_mode = (int(mode) + self._faults.mode_offset) & 0xFF
        told.song_number = songs.number
        told.song_playing = int(songs.playing(now))
        told.stream_packets = len(self._stream.ids) if self._stream else 0
        if now >= self._buttons_until_s:
            told.buttons = 0
        if self._faults.capacity_unknown:
            told.capacity_mah = 0
        data = layout.encode(told)
        # Reading packet 19 or 20 clears it.
        told.distance_mm = 0 if layout.takes_distance else told.distance_mm
        told.angle_deg = 0 if layout.takes_angle else told.angle_deg
        return data
