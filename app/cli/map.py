"""`map`: the campus that the service is set to. More about maps, and their markers: `python -m maps --help`."""

from dataclasses import asdict

import typer

from app.cli.output import FOUND_WRONG, AsJson, errors_in_words, say_json, say_table
from app.core.settings import load_settings, open_map
from maps.campus_map import map_path
from maps.check import check_file

cli = typer.Typer(
    no_args_is_help=True, add_completion=False, help="The campus map that the service is set to (CAMPUS_MAIL_MAP)."
)


@cli.command()
def show(as_json: AsJson = False) -> None:
    """Posts and corridors of the map."""
    with errors_in_words():
        campus = open_map(load_settings())
    if as_json:
        posts = [{"name": p.name, "title": p.title, "x_m": p.x_m, "y_m": p.y_m} for p in campus.posts.values()]
        corridors = [{"name": c.name, "a": c.a, "b": c.b, "length_m": c.length_m} for c in campus.corridors]
        say_json({"name": campus.name, "version": campus.version, "posts": posts, "corridors": corridors})
        return
    typer.echo(f"{campus.name}: {campus.title} (version {campus.version})\n{campus.note}\n")
    posts_seen = [
        (p.name, p.title, "dock" if p.dock else None, "mailroom" if p.mailroom else None) for p in campus.posts.values()
    ]
    say_table(("post", "title", "", ""), posts_seen, "No posts.")
    typer.echo("")
    lengths = [(c.name, f"{c.length_m:.1f}", "assumed" if c.assumed else None) for c in campus.corridors]
    say_table(("corridor", "m", ""), lengths, "No corridors.")


@cli.command()
def check(as_json: AsJson = False) -> None:
    """Check if robots can use it: unreachable posts, one-way corridors, missing docks. Exit code 1 if they cannot."""
    with errors_in_words():
        settings = load_settings()
        open_map(settings)
        path = map_path(settings.map)
    problems = check_file(path)
    if as_json:
        say_json({"map": str(path), "problems": [asdict(problem) for problem in problems]})
    else:
        typer.echo("\n".join(map(str, problems)) or f"{path}: no problems")
    if any(problem.severity == "error" for problem in problems):
        raise typer.Exit(FOUND_WRONG)
