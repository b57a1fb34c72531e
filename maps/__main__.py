"""The commands of `python -m maps`: check a map, look at it, print its markers, ask for a route."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from maps.campus_map import CampusMap, Post, find_map, map_path
from maps.check import check_file
from maps.errors import CampusMapError, MapError
from maps.problem import Problem
from maps.routes import shortest_route
from maps.sheets import marker_sheet

cli = typer.Typer(help=__doc__, no_args_is_help=True, add_completion=False)
MapArgument = Annotated[Path, typer.Argument(metavar="MAP", help="A map file, or the name of one that ships.")]
AsJson = Annotated[bool, typer.Option("--json", help="Machine-readable output.")]
UNREADABLE = 2


@cli.command()
def check(where: MapArgument, as_json: AsJson = False) -> None:
    """Name every problem of a map: one-way corridors, unknown or unreachable posts, missing docks, unseen markers.

    Exit status: 0 fit for robots (there may be warnings), 1 not fit, 2 not readable.
    """
    try:
        path = map_path(where)
        problems = check_file(path)
    except MapError as error:
        _unreadable(error, as_json)
        raise typer.Exit(UNREADABLE) from error
    errors = sum(problem.severity == "error" for problem in problems)
    if as_json:
        print(json.dumps({"map": str(path), "problems": [asdict(problem) for problem in problems]}, indent=2))
    else:
        _print_problems(path, problems)
    raise typer.Exit(1 if errors else 0)


def _unreadable(error: MapError, as_json: bool) -> None:
    if as_json:
        names = ("source", "place", "message", "way_out")
        print(json.dumps({"error": {name: getattr(error, name) for name in names}}, indent=2))
    else:
        typer.echo(str(error), err=True)


def _print_problems(path: Path, problems: tuple[Problem, ...]) -> None:
    for problem in problems:
        print(problem)
    print(f"{path}: {len(problems)} problems" if problems else f"{path}: no problems")


@cli.command()
def show(where: MapArgument) -> None:
    """A short table of the posts and the corridors between them."""
    campus = _map_or_exit(where)
    table = Table(title=f"{campus.title} ({campus.name}, version {campus.version})", title_justify="left")
    for heading in ("post", "title", "place, m", "markers", "dock", "corridors, m"):
        table.add_column(heading)
    for post in campus.posts.values():
        table.add_row(*_row(campus, post))
    console = Console()
    console.print(table)
    console.print("~ marks a length that is assumed, not measured.")
    console.print(campus.note)


def _row(campus: CampusMap, post: Post) -> tuple[str, ...]:
    ways = (
        f"{other.name} {'~' if corridor.assumed else ''}{corridor.length_m:.4g}"
        for other, corridor in campus.neighbours(post.name)
    )
    place = f"{post.x_m:g}, {post.y_m:g}"
    return post.name, post.title, place, str(len(post.markers)), "dock" if post.dock else "", ", ".join(ways)


@cli.command()
def route(where: MapArgument, start: str, goal: str) -> None:
    """The shortest route between two posts."""
    campus = _map_or_exit(where)
    try:
        found = shortest_route(campus, start, goal)
    except CampusMapError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(1) from error
    print(f"{' → '.join(found.posts)}: {found.length_m:.4g} m")


@cli.command()
def markers(
    where: MapArgument,
    out: Annotated[Path, typer.Option(help="The folder that the sheets go into.")] = Path("markers"),
) -> None:
    """One marker sheet (SVG, print at 100 %) for each post."""
    campus = _map_or_exit(where)
    out.mkdir(parents=True, exist_ok=True)
    for post in campus.posts.values():
        (out / f"{post.name}.svg").write_text(marker_sheet(post), encoding="utf-8")
    print(f"{len(campus.posts)} sheets in {out}")


def _map_or_exit(where: Path) -> CampusMap:
    try:
        return find_map(where)
    except MapError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(UNREADABLE) from error


if __name__ == "__main__":
    cli(prog_name="python -m maps")
