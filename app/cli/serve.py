"""`serve` and `migrate`: the service itself, and its database."""

import asyncio
import contextlib
from pathlib import Path
from typing import Annotated

import typer

from app.cli.administration import migrate as bring_up_to_date
from app.cli.output import errors_in_words
from app.core.errors import StartError
from app.core.logs import set_up_logs
from app.core.settings import Settings, load_settings
from app.core.settings_errors import in_sentences


def serve(
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    port: Annotated[int | None, typer.Option(help="TCP port to listen on; 0 takes a free one.")] = None,
    tls_cert: Annotated[Path | None, typer.Option(help="Certificate chain (PEM): serve https and wss.")] = None,
    tls_key: Annotated[Path | None, typer.Option(help="Private key of the certificate (PEM).")] = None,
) -> None:
    """Serve pages and API until Ctrl-C or SIGTERM. The database is made or brought up to date first.

    One process serves a campus: robots' sockets, event streams and rate limits live in its memory, and one dispatcher
    assigns. What it was measured to carry is in docs/reference/measurements.md.
    """
    from app.cli.serving import serve as serve_until_stopped

    with errors_in_words(), contextlib.suppress(KeyboardInterrupt):
        settings = settings_with(host=host, port=port, tls_cert=tls_cert, tls_key=tls_key)
        set_up_logs(settings.log_level)
        serve_until_stopped(settings)


def settings_with(**given: object) -> Settings:
    """The settings of the environment, and what was given as an option. Raises StartError."""
    settings = load_settings()
    wanted = {name: value for name, value in given.items() if value is not None}
    try:
        return Settings.model_validate({**settings.model_dump(), **wanted})
    except ValueError as error:
        raise StartError(f"The options cannot be used. {in_sentences(error, Settings.model_fields)}") from None


def migrate() -> None:
    """Bring the database to the schema of this version and do nothing else.

    `serve` does so too. Take a backup first if it matters: there is no way back from a newer schema.
    """
    with errors_in_words():
        settings = load_settings()
        set_up_logs(settings.log_level)
        asyncio.run(bring_up_to_date(settings))
