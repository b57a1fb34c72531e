"""Percepts of sensors whose values arrive one by one between the cycles.

    perception = Perception(default=Latest(age_limit_s=2.0), modes={"post": Drain()}, named_by={"distance": 1})
    perception.arrived("line(center)", now)
    perception.arrived("distance(left,0.4)", now)
    outcome = agent.cycle(perception.now(now), now=now)

A *sensor* is the name of a percept: `line(left)` takes the place of `line(center)`. Where one name stands for several
sensors, `named_by` says how many arguments belong to the sensor: with 1, `distance(left,D)` and `distance(right,D)` are
two. Each sensor has a mode:

`Latest`  its newest value is believed until a newer one comes, or it is too old: an event means a change.
`Drain`   what arrived since the last cycle is believed for one cycle, all of it: an event means an arrival.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

from bdi.language.errors import OtherSensor
from bdi.language.parser import literal_from
from bdi.language.terms import Term
from bdi.reasoning.percepts import REMEMBERED_TEXTS


@dataclass(frozen=True, slots=True)
class Latest:
    """The newest value, believed for `age_limit_s` seconds (None: until there is a newer one)."""

    age_limit_s: float | None = None


@dataclass(frozen=True, slots=True)
class Drain:
    """Everything that arrived since the last cycle, for one cycle."""


Mode = Latest | Drain
LATEST = Latest()
Value = Term | str  # a percept as `Agent.cycle` takes it


class Sensor(NamedTuple):
    """A name, and the arguments that tell it from others of that name."""

    name: str
    arguments: tuple[Term, ...] = ()


class _Reading(NamedTuple):
    values: frozenset[Value]
    at_s: float


class Perception:
    """The sensors of one agent. `modes` and `named_by` are by the name of the percept, without arguments."""

    def __init__(
        self,
        default: Mode = LATEST,
        modes: Mapping[str, Mode] = MappingProxyType({}),
        named_by: Mapping[str, int] = MappingProxyType({}),
    ) -> None:
        self._default = default
        self._modes = dict(modes)
        self._named_by = dict(named_by)
        self._latest: dict[Sensor, _Reading] = {}
        self._drained: set[Value] = set()
        self._sensors: dict[Value, Sensor] = {}

    def arrived(self, percept: Value, now: float) -> None:
        """One value of one sensor. Raises AgentSpeakSyntaxError and NotALiteral."""
        sensor = self._sensor_of(percept)
        if isinstance(self.mode_of(sensor.name), Drain):
            self._drained.add(percept)
        else:
            self._latest[sensor] = _Reading(frozenset((percept,)), now)

    def replace(self, name: str, percepts: Iterable[Value], now: float) -> None:
        """Replace all readings of this name, for sensors that can report several things at once, or nothing:
        `replace("fault", ["fault(bump)","fault(cliff)"], now)`. Raises like `arrived`, and then nothing has changed."""
        readings: dict[Sensor, set[Value]] = {}
        for percept in percepts:
            sensor = self._sensor_of(percept)
            if sensor.name != name:
                raise OtherSensor(name, percept)
            readings.setdefault(sensor, set()).add(percept)
        if isinstance(self.mode_of(name), Drain):
            self._drained.update(*readings.values())
            return
        self.forget(name)
        self._latest.update({sensor: _Reading(frozenset(values), now) for sensor, values in readings.items()})

    def forget(self, name: str) -> None:
        """The sensors of this name say nothing any more."""
        self._latest = {sensor: reading for sensor, reading in self._latest.items() if sensor.name != name}

    def now(self, now: float) -> frozenset[Value]:
        """Return the percepts of this cycle, and remove those that are drained."""
        self._latest = {
            sensor: reading for sensor, reading in self._latest.items() if self._is_fresh(sensor, reading, now)
        }
        drained, self._drained = self._drained, set()
        return frozenset(drained).union(*(reading.values for reading in self._latest.values()))

    def mode_of(self, name: str) -> Mode:
        return self._modes.get(name, self._default)

    def _is_fresh(self, sensor: Sensor, reading: _Reading, now: float) -> bool:
        mode = self.mode_of(sensor.name)
        limit_s = mode.age_limit_s if isinstance(mode, Latest) else None
        return limit_s is None or now - reading.at_s <= limit_s

    def _sensor_of(self, percept: Value) -> Sensor:
        sensor = self._sensors.get(percept)
        if sensor is None:
            literal = literal_from(percept)
            name = str(literal.predicate).removeprefix("~")  # what is known to be false is a value as well
            sensor = Sensor(name, literal.args[: self._named_by.get(name, 0)])
            if len(self._sensors) >= REMEMBERED_TEXTS:
                self._sensors.clear()
            self._sensors[percept] = sensor
        return sensor
