"""The commands of `python -m maps`: check a map, look at it, print its markers and tape plan, ask for a route.

Exit status of every command: 0 done, 1 not fit or no route, 2 something to put right first, which is named.
"""

import json
import math
from collections.abc import Iterator
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from maps.campus_map import CampusMap, Post, find_map, map_path
from maps.carrying import ASSUMED_SPEED_M_S, Carrying, carrying
from maps.check import check_file
from maps.drawing import as_pdf
from maps.errors import MapError, NoRoute, UnknownPost
from maps.problem import Problem
from maps.routes import shortest_route
from maps.sheets import all_pages, count_of, marker_sheet, places_with_sheets
from maps.tape_plan import tape_pages

cli = typer.Typer(help=__doc__, no_args_is_help=True, add_completion=False)
MapArgument = Annotated[Path, typer.Argument(metavar="MAP", help="A map file, or the name of one that ships.")]
AsJson = Annotated[bool, typer.Option("--json", help="Machine-readable output.")]
NOT_SO, MISUSE = 1, 2


@cli.command()
def check(
    where: MapArgument,
    as_json: AsJson = False,
    speed_m_s: Annotated[
        float, typer.Option("--speed", min=0.01, help="How fast robots drive, in m/s.")
    ] = ASSUMED_SPEED_M_S,
) -> None:
    """Name every problem of a map: one-way corridors, unknown or unreachable posts, missing docks, unseen markers; and
    how many robots it can carry, and why.

    Exit status: 0 fit for robots (there may be warnings), 1 not fit, 2 not readable.
    """
    try:
        path = map_path(where)
        problems = check_file(path)
    except MapError as error:
        _unreadable(error, as_json)
        raise typer.Exit(MISUSE) from error
    errors = sum(problem.severity == "error" for problem in problems)
    carried = None if errors else carrying(find_map(path), speed_m_s)
    if as_json:
        print(json.dumps(_as_facts(path, problems, carried), indent=2))
    else:
        _print_problems(path, problems)
        print(carried or "How many robots it carries is said when the errors are mended.")
    raise typer.Exit(NOT_SO if errors else 0)


def _as_facts(path: Path, problems: tuple[Problem, ...], carried: Carrying | None) -> dict[str, Any]:
    said = None if carried is None else {**asdict(carried), "why": str(carried)}
    return {"map": str(path), "problems": [asdict(problem) for problem in problems], "carries": said}


def _unreadable(error: MapError, as_json: bool) -> None:
    if as_json:
        names = ("source", "place", "message", "way_out")
        print(json.dumps({"error": {name: getattr(error, name) for name in names}}, indent=2))
    else:
        typer.echo(str(error), err=True)


def _print_problems(path: Path, problems: tuple[Problem, ...]) -> None:
    for problem in problems:
        print(problem)
    print(f"{path}: {len(problems) or 'no'} problem{'' if len(problems) == 1 else 's'}")


@cli.command()
def show(where: MapArgument) -> None:
    """A short table of the posts and the corridors between them."""
    campus = _map_or_exit(where)
    table = Table(title=f"{campus.title} ({campus.name}, version {campus.version})", title_justify="left")
    for heading in ("post", "title", "place, m", "markers", "bays", "corridors, m"):
        table.add_column(heading)
    for post in campus.posts.values():
        table.add_row(*_row(campus, post))
    console = Console()
    console.print(table)
    console.print("~ marks a length that is assumed, not measured; ! a post or corridor without network.")
    console.print(campus.note)


def _row(campus: CampusMap, post: Post) -> tuple[str, ...]:
    ways = (
        f"{other.name} {'~' if corridor.assumed else ''}{corridor.length_m:.4g}{'' if corridor.network else '!'}"
        for other, corridor in campus.neighbours(post.name)
    )
    place = f"{post.x_m:g}, {post.y_m:g}"
    name, markers = post.name + ("" if post.network else "!"), str(len(post.markers))
    return name, post.title, place, markers, ", ".join(_bays(post)), ", ".join(ways)


def _bays(post: Post) -> Iterator[str]:
    """Each bay on the floor by its bearing, or only the dock of a map from before there were such."""
    for bay in post.spurs:
        uses = f"{' home' if bay.home else ''}{' dock' if bay.dock else ''}"
        yield f"{math.degrees(bay.bearing_rad):.4g}°{uses}"
    if post.dock and not post.spurs:
        yield "dock"


@cli.command()
def route(where: MapArgument, start: str, goal: str) -> None:
    """The shortest route between two posts. Exit status 1: there is none."""
    campus = _map_or_exit(where)
    _posts_or_exit(campus, [start, goal])
    try:
        found = shortest_route(campus, start, goal)
    except NoRoute as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(NOT_SO) from error
    print(f"{' → '.join(found.posts)}: {found.length_m:.4g} m")


class Format(StrEnum):
    SVG = "svg"
    PDF = "pdf"


@cli.command()
def markers(
    where: MapArgument,
    out: Annotated[Path, typer.Option(help="The folder that the sheets go into.")] = Path("markers"),
    format: Annotated[
        Format, typer.Option(help="svg: a file for each post and bay; pdf: everything in one.")
    ] = Format.PDF,
    april_tags: Annotated[
        bool, typer.Option("--april-tags", help="With an AprilTag below each code, for robots set to read them.")
    ] = False,
    post: Annotated[list[str] | None, typer.Option(help="Only this post and its bays; may be repeated.")] = None,
) -> None:
    """Marker sheets for the printer, at 100 %: as many of each post and bay as it has markers."""
    campus = _map_or_exit(where)
    places = places_with_sheets(campus, _posts_or_exit(campus, post))
    sheets = sum(len(place.markers) for place in places)
    try:
        out.mkdir(parents=True, exist_ok=True)
        if format is Format.PDF:
            path = out / f"{campus.name}.pdf"
            path.write_bytes(as_pdf(all_pages(campus, places, april_tags), f"Markers of {campus.title}"))
            print(f"{sheets} sheets for {count_of(places)}, and a page that explains: {path}")
        else:
            for place in places:
                (out / f"{place.name}.svg").write_text(marker_sheet(place, april_tags), encoding="utf-8")
            print(f"{len(places)} sheets in {out}; print {sheets}, as many of each as it says")
    except OSError as error:
        typer.echo(f"{out}: the sheets cannot be written there: {error.strerror}. Give --out FOLDER.", err=True)
        raise typer.Exit(MISUSE) from error


@cli.command()
def tape(
    where: MapArgument,
    out: Annotated[Path, typer.Option(help="The PDF that is written.")] = Path("tape-plan.pdf"),
) -> None:
    """The tape plan, a PDF: what to tape where, with lengths and angles, an overview and a page for each post with
    bays."""
    campus = _map_or_exit(where)
    pages = tape_pages(campus)
    try:
        out.write_bytes(as_pdf(pages, f"Tape plan of {campus.title}"))
    except OSError as error:
        typer.echo(f"{out}: the plan cannot be written there: {error.strerror}. Give --out FILE.pdf.", err=True)
        raise typer.Exit(MISUSE) from error
    with_bays = sum(bool(post.spurs) for post in campus.posts.values())
    print(f"{out}: the campus, and {with_bays} of {len(campus.posts)} posts, those with bays")


def _posts_or_exit(campus: CampusMap, names: list[str] | None) -> list[Post]:
    try:
        return [campus.post(name) for name in names or campus.posts]
    except UnknownPost as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(MISUSE) from error


def _map_or_exit(where: Path) -> CampusMap:
    try:
        return find_map(where)
    except MapError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(MISUSE) from error


if __name__ == "__main__":
    cli(prog_name="python -m maps")
