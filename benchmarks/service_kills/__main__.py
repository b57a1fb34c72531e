"""SIGKILL of the service at random moments under load: what it has kept and told (`make bench-service-kills`)."""

import asyncio
import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from benchmarks.service_kills.run import Plan, killed

NOT_MET = 1


def main(
    kills: Annotated[int, typer.Option(min=1, help="How often; half of it with SMTP, half with the spool.")] = 300,
    seed: Annotated[int, typer.Option(help="Fixes when the kills come.")] = 1,
    as_json: Annotated[bool, typer.Option("--json", help="The figures alone, on stdout.")] = False,
    keep: Annotated[Path | None, typer.Option(help="New folder in which databases and logs are kept.")] = None,
) -> None:
    """Kill the service under load, let it finish in peace, and compare what was promised with what is there.

    Exit status 1: something was lost, doubled or contradicts itself; `wrong` names each.
    """
    runs = []
    with (
        Progress(console=Console(stderr=True), disable=as_json) as bar,
        TemporaryDirectory(prefix="kills-") as temporary,
    ):
        task = bar.add_task("kills", total=kills)
        for with_smtp, share in ((True, kills - kills // 2), (False, kills // 2)):
            if share:
                folder = (keep or Path(temporary)) / ("smtp" if with_smtp else "spool")
                folder.mkdir(parents=True)
                plan = Plan(kills=share, seed=seed, with_smtp=with_smtp)
                runs.append(asyncio.run(killed(plan, folder, lambda _: bar.advance(task))))
    wrong = [sentence for run in runs for sentence in run["wrong"]]
    print(json.dumps({"kills": sum(run["kills"] for run in runs), "wrong": len(wrong), "runs": runs}, indent=2))
    raise typer.Exit(NOT_MET if wrong else 0)


if __name__ == "__main__":
    typer.run(main)
