"""The service's commands: `python -m app --help`."""

import typer

from app.commands import backup, demo, fleet_demo, map, orders, people, personal, retain, robots, serve

HELP = """Campus Mail: the service.

Everything is set by environment variables (CAMPUS_MAIL_…, docs/service.md); commands work beside a running service,
but for `restore`. Exit status: 0 done, 1 looked and found something wrong, 2 could not be done, and why is on stderr.
"""
app = typer.Typer(no_args_is_help=True, add_completion=False, help=HELP)
app.command()(serve.serve)
app.command()(serve.migrate)
app.add_typer(people.cli, name="people")
app.add_typer(robots.cli, name="robots")
app.add_typer(orders.cli, name="orders")
app.add_typer(map.cli, name="map")
app.command()(backup.backup)
app.command()(backup.restore)
app.command()(personal.export)
app.command()(personal.erase)
app.command()(retain.retain)
app.command()(demo.demo)
app.command()(fleet_demo.fleet_demo)

if __name__ == "__main__":
    app()
