"""Songs: five places for up to sixteen notes each; one plays at a time."""

from dataclasses import dataclass, field

DURATIONS_PER_S = 64
PLACES = 5  # the manual says "up to four"; the firmware keeps five numbers, 0 to 4


@dataclass
class SongBook:
    """`number` is the song chosen last (packet 36)."""

    songs: dict[int, tuple[tuple[int, int], ...]] = field(default_factory=dict)
    number: int = 0
    played: list[int] = field(default_factory=list)
    _ends_at_s: float = 0.0

    def define(self, number: int, notes: tuple[tuple[int, int], ...]) -> None:
        """Notes are (MIDI number, duration in 1/64 s). A wrong number or length is not kept [A]."""
        if number < PLACES and 1 <= len(notes) <= 16:
            self.songs[number] = notes

    def play(self, number: int, now: float) -> None:
        """Ignored while another song plays ([F]) and for a song that was never defined."""
        if number not in self.songs or self.playing(now):
            return
        self.number = number
        self.played.append(number)
        self._ends_at_s = now + sum(duration for _, duration in self.songs[number]) / DURATIONS_PER_S

    def playing(self, now: float) -> bool:
        return now < self._ends_at_s
