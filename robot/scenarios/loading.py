"""A scenario from its file, or one that is drawn by a seed; what is wrong in it is named with the nearest spelling."""

import tomllib
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final, get_args

from pydantic import BaseModel, ValidationError

from maps import CampusMap
from maps.errors import CampusMapError
from robot.scenarios.campus import campus_of
from robot.scenarios.errors import ScenarioError
from robot.scenarios.replay.drawing import drawn
from robot.scenarios.scenario import Place, Scenario, Stander, Table
from robot.simulated import SWITCHES, Faults, SimulatedWorldError
from robot.simulated.start import start_pose

DRAWN: Final = "drawn:"


def load_scenario(file: str, seed: int | None = None) -> tuple[Scenario, Path | None]:
    """A file, or `drawn:track` and `drawn:tunnels` with a seed. Raises ScenarioError."""
    if file.startswith(DRAWN):
        return drawn(file.removeprefix(DRAWN), 1 if seed is None else seed), None
    path = Path(file)
    scenario = read_scenario(path)
    if seed is not None:
        scenario = scenario.model_copy(update={"seed": seed})
    return scenario, path


def read_scenario(path: Path) -> Scenario:
    """Read and check one file. Raises ScenarioError: a key, value, post, corridor or switch that is not there."""
    try:
        scenario = Scenario.model_validate(tomllib.loads(path.read_text("utf-8")))
    except OSError as error:
        raise ScenarioError(str(path), "file", f"cannot be read: {error.strerror}", "Check the path.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ScenarioError(str(path), "file", f"is not TOML: {error}") from None
    except ValidationError as error:
        raise _named(str(path), error) from None
    for key, message, way_out in problems(scenario, path):
        raise ScenarioError(str(path), key, message, way_out)
    return scenario


def _named(source: str, error: ValidationError) -> ScenarioError:
    first = error.errors()[0]
    key = ".".join(str(part + 1) if isinstance(part, int) else str(part) for part in first["loc"])
    if first["type"] != "extra_forbidden":
        return ScenarioError(
            source, key, first["msg"].removeprefix("Value error, "), "docs/reference/scenario-keys.md lists every key."
        )
    plain = ".".join(str(part) for part in first["loc"] if not isinstance(part, int))
    nearest = get_close_matches(plain, sorted(keys()), n=1, cutoff=0.4)
    return ScenarioError(source, key, "there is no such key", f"Did you mean {nearest[0]!r}?" if nearest else "")


def keys(table: type[Table] = Scenario, prefix: str = "") -> dict[str, str]:
    """Every key by its dotted path, with its description: what the page has to name."""
    found: dict[str, str] = {}
    for name, field in table.model_fields.items():
        spelled = prefix + (field.alias or name)
        inner = _table_in(field.annotation)
        found |= keys(inner, f"{spelled}.") if inner else {spelled: field.description or ""}
    return found


def _table_in(annotation: Any) -> type[Table] | None:
    kinds = [annotation, *get_args(annotation)]
    return next((kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)), None)  # type: ignore[return-value]


Complaint = tuple[str, str, str]


def problems(scenario: Scenario, source: Path | None = None) -> Iterator[Complaint]:
    """Return faults that the shape allows and the map does not: (key, what is wrong, way out)."""
    try:
        campus = campus_of(scenario.map, source)
    except CampusMapError as error:
        yield "map", str(error), ""
        return
    robots = {robot.name for robot in scenario.robot}
    yield from _robots(scenario, campus)
    yield from _orders(scenario, campus, robots)
    yield from _places(scenario, campus)
    yield from _happenings(scenario, campus, robots)


def _robots(scenario: Scenario, campus: CampusMap) -> Iterator[Complaint]:
    names = [robot.name for robot in scenario.robot]
    if len(set(names)) < len(names):
        yield "robot.name", "two robots have the same name", "Give each one of its own."
    for robot in scenario.robot:
        try:
            start_pose(campus, robot.start)
        except SimulatedWorldError as error:
            yield "robot.start", str(error), ""
        if robot.home is not None and campus.track.home_at(robot.home) is None:
            homes = ", ".join(place.name for place in campus.track.homes) or "none"
            yield "robot.home", f"{robot.home} is no home on this map", f"There are: {homes}."


def _orders(scenario: Scenario, campus: CampusMap, robots: set[str]) -> Iterator[Complaint]:
    names = [order.id for order in scenario.order]
    if len(set(names)) < len(names):
        yield "order.id", "two orders have the same name", "Give each one of its own."
    for order in scenario.order:
        for key, post in (("from", order.origin), ("to", order.destination)):
            yield from _post(f"order.{key}", post, campus)
        if order.robot is not None:
            yield from _one_of("order.robot", order.robot, robots)
    for key, orders in (("delivered", scenario.expect.delivered or ()), ("handed_over", scenario.expect.handed_over)):
        for name in orders:
            yield from _one_of(f"expect.{key}", name, set(names))


def _places(scenario: Scenario, campus: CampusMap) -> Iterator[Complaint]:
    corridors = {corridor.name for corridor in campus.corridors}
    rows: list[tuple[str, Place | Stander]] = [
        *(("dark", row) for row in scenario.dark),
        *(("no_network", row) for row in scenario.no_network),
        *(("stander", row) for row in scenario.stander),
    ]
    for key, row in rows:
        if row.at is not None and row.corridor is not None:
            yield key, "both at and corridor are given", "Keep one."
        if row.corridor is not None:
            yield from _one_of(f"{key}.corridor", row.corridor, corridors)
        if isinstance(row, Stander) and row.at is None and row.corridor is None:
            yield key, "the place is missing", "Give at or corridor."
    for post in scenario.dirt:
        yield from _post("dirt", post, campus.track)


def _happenings(scenario: Scenario, campus: CampusMap, robots: set[str]) -> Iterator[Complaint]:
    for key, rows in (("fault", scenario.fault), ("deed", scenario.deed), ("message", scenario.message)):
        for row in rows:
            if row.robot is not None:
                yield from _one_of(f"{key}.robot", row.robot, robots)
            if row.after_post is not None:
                yield from _post(f"{key}.after_post", row.after_post, campus.track)
    for fault in scenario.fault:
        try:
            Faults().set(fault.switch, fault.value)
        except SimulatedWorldError as error:
            nearest = get_close_matches(fault.switch, SWITCHES, n=1)
            yield (
                "fault",
                str(error),
                f"Did you mean {nearest[0]!r}?" if nearest and fault.switch not in SWITCHES else "",
            )
    for message in scenario.message:
        if message.say == "cancel":
            yield from _one_of("message.order", message.order or "", {order.id for order in scenario.order})
    for deed in scenario.deed:
        if deed.do == "show_code" and not deed.text:
            yield "deed.text", "no text is given to show", "Give one, as text = 'post4'."
        if deed.do == "carry":
            try:
                start_pose(campus, deed.to or "")
            except SimulatedWorldError as error:
                yield "deed.to", str(error), ""


def _post(key: str, name: str, campus: CampusMap) -> Iterator[Complaint]:
    yield from _one_of(key, name, set(campus.posts))


def _one_of(key: str, name: str, known: set[str]) -> Iterator[Complaint]:
    if name in known:
        return
    nearest = get_close_matches(name, known, n=1)
    way_out = f"Did you mean {nearest[0]!r}?" if nearest else f"There are: {', '.join(sorted(known)) or 'none'}."
    yield key, f"there is no {name!r}", way_out
