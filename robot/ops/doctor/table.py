"""The checks in the order in which they are made and shown."""

from collections.abc import Iterator

from robot.ops.doctor import cable, computer, senses, service
from robot.ops.doctor.findings import Finding, Look, Subjects, fail

CHECKS: tuple[tuple[str, Look], ...] = (
    ("packages", computer.packages),
    ("settings", computer.settings),
    ("disk", computer.disk),
    ("clock", computer.clock),
    ("supply", computer.supply),
    ("port", cable.port),
    ("latency", cable.latency),
    ("base", cable.base),
    ("wake-up", cable.wake_up),
    ("console", cable.console),
    ("line", senses.pins),
    ("camera", senses.camera),
    ("service", service.token),
    ("map", service.map_version),
)


def examine(patient: Subjects) -> Iterator[tuple[str, Finding]]:
    """One finding for each check; a check that breaks is a finding too, and the others are made."""
    for name, look in CHECKS:
        try:
            yield name, look(patient)
        except Exception as error:
            yield name, fail(f"the check itself broke: {error!r}", "Please report this.")
