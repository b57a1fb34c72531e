"""Updates of a mission: which contradict the one held, and which stop of a new one comes next."""

from protocol.to_robot import Mission


class MissionConflict(ValueError):
    """Other stops under the number of the mission that is held: one of the two sides is wrong. Nothing is changed."""

    code = "mission_conflict"


def next_undone(mission: Mission | None, number: int, done: frozenset[str]) -> int:
    """The first stop from this number on that was not done under an earlier update."""
    stops = mission.stops if mission else ()
    while number < len(stops) and stops[number].id in done:
        number += 1
    return number


def conflict(held: Mission | None, offered: Mission) -> MissionConflict | None:
    """The contradiction between two missions, if they are the same one under the same number with other stops."""
    if held is None or (held.id, held.update) != (offered.id, offered.update) or held.stops == offered.stops:
        return None
    return MissionConflict(f"mission {held.id} update {held.update} came again with other stops; the first is kept")
