"""Three photo-diodes on digital pins, sampled often and read by majority: single flipped reads must not count."""

from gpiozero import DigitalInputDevice

from .interfaces import LineReading


class ThreeDiodes:
    """See `interfaces.LineSensor`. Pins as gpiozero spells them (`BOARD8`); always with an explicit pin factory."""

    def __init__(self, left: str, centre: str, right: str, pin_factory: object, line_is_low: bool = True) -> None:
        self._devices = tuple(
            DigitalInputDevice(pin, pull_up=None, active_state=not line_is_low, pin_factory=pin_factory)
            for pin in (left, centre, right)
        )
        self._votes = [0, 0, 0]
        self._samples = 0
        self._reading = LineReading(False, False, False)

    def sample(self) -> None:
        """See `interfaces.LineSensor.sample`."""
        votes = self._votes
        for i, device in enumerate(self._devices):
            votes[i] += device.value
        self._samples += 1

    def read(self) -> LineReading:
        """The majority of the samples since the last read; with a tie (or no sample) a diode stays as it was."""
        if self._samples:
            half = self._samples / 2
            before = self._reading
            self._reading = LineReading(
                *(was if votes == half else votes > half for votes, was in zip(self._votes, before, strict=True))
            )
            self._votes, self._samples = [0, 0, 0], 0
        return self._reading

    def close(self) -> None:
        """Give the pins back."""
        for device in self._devices:
            device.close()
