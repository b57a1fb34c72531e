"""Three photo-diodes on digital pins, sampled often and read by majority: single flipped reads must not count."""

from gpiozero import DigitalInputDevice

from robot.drivers.interfaces import NOTHING_SEEN, LineReading

TO_CHANGE = 0.6
"""A diode changes only with more than this share of the samples: 2 of 2, 2 of 3, 3 of 4, 7 of 10."""


class ThreeDiodes:
    """See `interfaces.LineSensor`. Pins as gpiozero spells them (`BOARD8`); always with an explicit pin factory."""

    def __init__(self, left: str, centre: str, right: str, pin_factory: object, line_is_low: bool = True) -> None:
        self._devices = tuple(
            DigitalInputDevice(pin, pull_up=None, active_state=not line_is_low, pin_factory=pin_factory)
            for pin in (left, centre, right)
        )
        self._votes = [0, 0, 0]
        self._samples = 0
        self._reading = NOTHING_SEEN

    def sample(self) -> None:
        """See `interfaces.LineSensor.sample`."""
        votes = self._votes
        for i, device in enumerate(self._devices):
            votes[i] += device.value
        self._samples += 1

    def read(self) -> LineReading:
        """The majority of the samples since the last read; one that is no clear majority leaves a diode as it was."""
        if self._samples:
            left, centre, right = self._votes
            was = self._reading
            self._reading = LineReading(
                self._voted(left, was.left), self._voted(centre, was.centre), self._voted(right, was.right)
            )
            self._votes, self._samples = [0, 0, 0], 0
        return self._reading

    def _voted(self, votes: int, was: bool) -> bool:
        share = votes / self._samples
        return share > TO_CHANGE if not was else share >= 1 - TO_CHANGE

    def close(self) -> None:
        """Give the pins back."""
        for device in self._devices:
            device.close()
