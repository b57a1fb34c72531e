"""A run written down as it goes: gzip, one JSON object a line, the first one the scenario, the last one how it ended.

Rows have `t` (s), `kind` and mostly `robot`. `state` comes five times a second; everything else when it changes:

| kind | with |
|---|---|
| `scenario` | title, about, seed, map, robots, dark places, patches without network |
| `state` | x, y (m), heading (rad), speed (mm/s), line (0 over the tape), skill, battery, where it believes to be |
| `people` | places: [x, y, radius] of everybody in the tunnel |
| `why`, `doing`, `percepts` | what the robot says, its actions under way, what the agent perceives |
| `intentions` | [number, events and goals from the first cause to the last] of each of the agent's intentions |
| `fault` | name, on |
| `event` | what happened or was told, in words |
| `mail` | order, place: who has it now |
| `end` | fates, what was not as expected |
"""

import gzip
import json
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Final

from maps import CampusMap
from robot.agent.mind import Mind
from robot.agent.perception.percepts import perceive
from robot.scenarios.actors.actors import Actor
from robot.scenarios.errors import RecordingError
from robot.scenarios.judging import Ending, shortfalls
from robot.scenarios.places import stands_at
from robot.scenarios.scenario import Place, Scenario
from robot.scenarios.stage import Stage

VERSION: Final = 1
EVERY_S: Final = 0.2
Row = dict[str, Any]


class Recorder:
    """`with Recorder(path, stage): …`. Raises RecordingError."""

    def __init__(self, path: Path, stage: Stage) -> None:
        self._path, self._stage = path, stage
        self._last: dict[tuple[str, str], Any] = {}
        self._state_s = -EVERY_S
        try:
            self._file = gzip.open(path, "wt", encoding="utf-8")  # noqa: SIM115  # closed by __exit__
        except OSError as error:
            raise RecordingError(f"{path}: cannot be written: {error.strerror}. Give another --record.") from None
        self._write({"kind": "scenario", "version": VERSION, **_head(stage.scenario, stage.campus)})
        stage.watchers.append(self.look)
        self._say, stage.say = stage.say, self._hear

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def _write(self, row: Row) -> None:
        try:
            self._file.write(json.dumps(row, separators=(",", ":")) + "\n")
        except OSError as error:
            raise RecordingError(f"{self._path}: cannot be written: {error.strerror}. Free some room.") from None

    def _hear(self, at_s: float, who: str, what: str) -> None:
        self._say(at_s, who, what)
        self._write({"t": round(at_s, 2), "kind": "event", "robot": who, "text": what})

    def look(self, now: float) -> None:
        """After every tick of the stage."""
        stage = self._stage
        self._on_change(
            now, "people", "", [[round(p.x_m, 2), round(p.y_m, 2), p.radius_m] for p in stage.crowd.present]
        )
        for order, letter in stage.letters.items():
            self._on_change(now, "mail", order, letter.place)
        for actor in stage.actors:
            self._look_at_mind(actor, now)
        if now - self._state_s >= EVERY_S - 1e-6:
            self._state_s = now
            for actor in stage.actors:
                self._write({"t": round(now, 2), "kind": "state", "robot": actor.name, **_state(actor)})

    def _look_at_mind(self, actor: Actor, now: float) -> None:
        mind = actor.parts.mind
        view = mind.hands.body.view
        why = mind.why
        self._on_change(now, "why", actor.name, why.sentence if why else "")
        self._on_change(now, "doing", actor.name, list(mind.actions.under_way))
        self._on_change(now, "intentions", actor.name, _intentions(mind))
        self._on_change(
            now, "percepts", actor.name, sorted(perceive(mind.seen(now), mind.mode, mind.settings.mind.age_limit_s))
        )
        before = self._last.get(("faults", actor.name), frozenset())
        for name in sorted(before ^ view.faults):
            self._write(
                {"t": round(now, 2), "kind": "fault", "robot": actor.name, "name": name, "on": name in view.faults}
            )
        self._last["faults", actor.name] = view.faults

    def _on_change(self, now: float, kind: str, whose: str, value: object) -> None:
        if self._last.get((kind, whose)) == value:
            return
        self._last[kind, whose] = value
        self._write({"t": round(now, 2), "kind": kind, "robot": whose, "value": value})

    def end(self, ending: Ending) -> None:
        """The last row."""
        fates = {one.order: [one.fate, one.why] for one in ending.verdicts}
        missing = shortfalls(ending, self._stage.scenario.expect)
        self._write({"t": round(self._stage.clock.now(), 2), "kind": "end", "fates": fates, "not_as_expected": missing})


def _intentions(mind: Mind) -> list[list[Any]]:
    stacks = [[one.number, [str(means.event) for means in one.stack]] for one in mind.agent.intentions.values()]
    return sorted(stacks, key=lambda stack: stack[0])


def _state(actor: Actor) -> Row:
    pose, base = actor.body.pose, actor.body.body.base
    view, navigator = actor.parts.mind.hands.body.view, actor.parts.navigator
    return {
        "x": round(pose.x_m, 3),
        "y": round(pose.y_m, 3),
        "heading": round(pose.heading_rad, 3),
        "speed": round((base.left.speed_mm_s + base.right.speed_mm_s) / 2),
        "line": view.reading.pattern,
        "skill": ("search" if view.searching else view.motion) or "",
        "battery": round(actor.body.battery.ratio, 3),
        "docked": actor.body.docked,
        "online": actor.link.online,
        "at": navigator.here or "",
        "towards": navigator.towards or "",
    }


def _head(scenario: Scenario, campus: CampusMap) -> Row:
    return {
        "title": scenario.title,
        "about": scenario.about,
        "seed": scenario.seed,
        "map": _map(campus),
        "robots": [robot.name for robot in scenario.robot],
        "dirt": scenario.dirt,
        "dark": [_place(row, campus) for row in scenario.dark],
        "no_network": [_place(row, campus) for row in scenario.no_network],
        "standers": [[*stands_at(row, campus), row.radius_m] for row in scenario.stander],
    }


def _map(campus: CampusMap) -> Row:
    track = campus.track
    docks = [place.dock for place in track.docks() if place.dock]
    return {
        "title": campus.title,
        "posts": [[post.name, post.x_m, post.y_m] for post in campus.posts.values()],
        "corridors": [[corridor.name, [list(point) for point in corridor.tape]] for corridor in track.corridors],
        "markers": [
            [round(one.x_m, 3), round(one.y_m, 3), round(one.heading_rad, 3)]
            for place in track.posts.values()
            for one in place.markers
        ],
        "docks": [[dock.x_m, dock.y_m, dock.heading_rad] for dock in docks],
    }


def _place(place: Place, campus: CampusMap) -> Row:
    if place.corridor is not None:
        return {"tape": [list(point) for point in campus.corridor_named(place.corridor).tape]}
    return {"at": place.at, "radius": place.radius_m}


def read_recording(path: Path) -> list[Row]:
    """Return all rows. Raises RecordingError. One that was cut off in the middle is read as far as it goes."""
    rows = list(_rows(path))
    if not rows or rows[0].get("kind") != "scenario":
        raise RecordingError(
            f"{path}: this is no recording. Make one: python -m robot.scenarios run FILE --record {path}"
        )
    if rows[0].get("version") != VERSION:
        raise RecordingError(f"{path}: version {rows[0].get('version')} is not {VERSION}. Record the run again.")
    return rows


def _rows(path: Path) -> Iterator[Row]:
    try:
        with gzip.open(path, "rt", encoding="utf-8") as file:
            for line in file:
                yield json.loads(line)
    except EOFError:
        return  # killed while it wrote
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise RecordingError(f"{path}: cannot be read as a recording: {reason}") from None
