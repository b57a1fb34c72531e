"""The battery and its charger.

Figures: NiMH 2696 mAh, 14.4 V nominal; charging currents and states after the service manual as reported in the field
[F]; voltages by charge, loads of the parts [A].
"""

from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise


class Charging(IntEnum):
    """Packet 21 [S]."""

    NOT = 0
    RECONDITION = 1
    FULL = 2
    TRICKLE = 3
    WAITING = 4
    FAULT = 5


# Share of the charge → voltage without load, in mV [A].
VOLTAGE_MV = ((0.0, 11000), (0.05, 12600), (0.10, 13100), (0.25, 13900), (0.50, 14500), (0.90, 15400), (1.0, 16000))
RESISTANCE_OHM = 0.3
CHARGING_MV = 17400
CURRENT_MA = {Charging.RECONDITION: 300.0, Charging.FULL: 1250.0, Charging.TRICKLE: 50.0}
RECONDITION_BELOW_MV = 10800
CONTACT_BEFORE_CHARGE_S = 1.0


@dataclass(frozen=True)
class Pack:
    """Settings of one battery. A demo may take a small pack so that it runs low soon.

    `idle_ma` is what the base draws awake, `host_ma` a computer fed from it (trickle charge ignores that load),
    `full_at` the ratio at which the charger ends: a worn pack stops short of 1.0. `charger_ma` is the full charge.
    """

    capacity_mah: float = 2696.0
    ratio: float = 1.0
    idle_ma: float = 250.0
    host_ma: float = 0.0
    full_at: float = 1.0
    charger_ma: float = 1250.0


class Battery:
    """Charge, voltage and what the charger does; `step` is one slice of time."""

    def __init__(self, pack: Pack) -> None:
        self.pack = pack
        self.charge_mah = pack.capacity_mah * pack.ratio
        self.current_ma = -pack.idle_ma
        self.temperature_c = 25.0
        self.state = Charging.NOT
        self.charging_s = 0.0
        self._contact_s = 0.0

    @property
    def ratio(self) -> float:
        return self.charge_mah / self.pack.capacity_mah

    @property
    def voltage_mv(self) -> int:
        if self.state in CURRENT_MA:
            return round(CHARGING_MV - (1.0 - min(self.ratio, 1.0)) * 1000)
        return round(open_voltage_mv(self.ratio) + RESISTANCE_OHM * self.current_ma)

    def sag(self, ratio: float) -> None:
        """The charge is suddenly this share of the capacity."""
        self.charge_mah = self.pack.capacity_mah * ratio
        if self.state in (Charging.TRICKLE, Charging.WAITING):
            self.state = Charging.NOT

    def step(self, duration_s: float, motors_ma: float, powered: bool, may_charge: bool, fault: bool) -> None:
        """`powered`: the contacts touch a live charger; `may_charge`: the interface is Off or Passive."""
        self._contact_s = self._contact_s + duration_s if powered else 0.0
        self.state = self._next_state(powered and may_charge, fault)
        self.charging_s = self.charging_s + duration_s if self.state in CURRENT_MA else 0.0
        load_ma = self.pack.host_ma + (0.0 if powered else self.pack.idle_ma + motors_ma)
        charge_ma = self.pack.charger_ma if self.state is Charging.FULL else CURRENT_MA.get(self.state, 0.0)
        self.current_ma = charge_ma - load_ma
        self.charge_mah += self.current_ma * duration_s / 3600
        self.charge_mah = min(max(self.charge_mah, 0.0), self.pack.capacity_mah)

    def _next_state(self, charger: bool, fault: bool) -> Charging:
        if not charger:
            return Charging.NOT
        if fault:
            return Charging.FAULT
        if self.state in (Charging.TRICKLE, Charging.WAITING):
            return self.state  # a full charge does not begin again by itself, whatever is drawn meanwhile
        if self._contact_s < CONTACT_BEFORE_CHARGE_S:
            return Charging.NOT
        if self.ratio >= self.pack.full_at:
            return Charging.TRICKLE
        return Charging.RECONDITION if open_voltage_mv(self.ratio) < RECONDITION_BELOW_MV else Charging.FULL


def open_voltage_mv(ratio: float) -> float:
    """Between the points of VOLTAGE_MV in straight lines."""
    for (low, low_mv), (high, high_mv) in pairwise(VOLTAGE_MV):
        if ratio <= high:
            return low_mv + (high_mv - low_mv) * (max(ratio, 0.0) - low) / (high - low)
    return float(VOLTAGE_MV[-1][1])
