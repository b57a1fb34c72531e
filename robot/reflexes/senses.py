"""The input of the reflexes at one tick."""

from dataclasses import dataclass

from robot.drivers.interfaces import BaseState, HostReport

WELL = HostReport()


@dataclass(slots=True)
class Senses:
    """One moment. Ages are seconds; `lasting.Lasting` fills in what only shows over time."""

    base: BaseState | None
    """Newest frame; None before the first."""
    base_age_s: float
    mind_age_s: float
    """Since the last heartbeat of the mind."""
    camera_age_s: float = 0.0
    """Since the last picture, a frozen one too."""
    camera_frozen_s: float = 0.0
    """The camera has given the same picture for so long."""
    stop_asked: bool = False
    """An emergency stop from the command line, the service or a person's page."""
    rearm: bool = False
    """A person has looked, and lets the robot go again: from anywhere, or by the Spot button, which works when
    everything above is dead. For one tick: a button that is still held must not undo the next stop."""
    own_wheels: bool = True
    """False while the firmware drives (docking touches the dock, which is no accident) or the base rests in Passive."""
    host: HostReport = WELL
    """What the computer says of itself."""
    offline_s: float = 0.0
    """Without the service for so long; 0 while connected, or when the robot works alone."""
    standing: bool = False
    """A wheel that should turn gave no count since the last frame."""
    slipping_s: float = 0.0
    """Wheels turn straight ahead for so long, but neither the caster nor line nor marker says that the robot moves."""
    constant_mm: float = 0.0
    """Travelled since a diode last changed."""
    impossible_mm: float = 0.0
    """Travelled with a pattern of the diodes that no tape makes."""
    sees_line: bool = False
    """Some diode is over the line."""
    diodes_broken: bool = False
    """The pins cannot be read at all."""
