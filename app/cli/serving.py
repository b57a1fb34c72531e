"""Listens and serves until told to stop; then lets go of open event streams at once, and of the rest in order:
requests, what runs in the background, the outbox (`app.composition`)."""

import asyncio
import errno
import gc
import socket
import ssl

import uvicorn
from fastapi import FastAPI

from app.cli.administration import migrate
from app.composition import create_app
from app.composition.parts import parts_of
from app.core.errors import StartError
from app.core.settings import Settings, open_clock
from app.http.connection_timeouts import PunctualConfig
from app.retention.data_folder_lock import the_only_one
from app.robots.link.keepalive import ANSWERS_WITHIN_S, LOOKS_AFTER_S, AttentiveSocket

# Without this an open event stream holds the server for ever. Streams end by themselves sooner (see `shutdown`).
GRACEFUL_S = 2
GARBAGE_AT = (50_000, 10, 200)
"""After so many new objects the youngest are looked through for garbage; of how many such looks one goes further back.

What the messages of a thousand robots hold for a moment needs no look: it goes when they are done. At 2,000 the looks
took 6 % of the processor, and each stopped everything for 5 to 40 ms (measured)."""
ANOTHER_FOLDER = "Stop that one, or give this one a data folder of its own: CAMPUS_MAIL_DATA."


class PortInUse(StartError):
    """Another program listens on this port."""

    def __init__(self, host: str, port: int, verb: str) -> None:
        other = f"--port {port + 1}"
        super().__init__(
            f"Port {port} on {host} is taken by another program, perhaps another Campus Mail. "
            f'Stop that one, or choose another port: {other}, or make {verb} ARGS="{other}".'
        )


class Server(uvicorn.Server):
    """Ends the event streams before it waits for connections to end."""

    def __init__(self, app: FastAPI, config: uvicorn.Config) -> None:
        super().__init__(config)
        self._app = app

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        parts_of(self._app).feed.close()
        await super().shutdown(sockets)


def listen(host: str, port: int, verb: str = "serve") -> socket.socket:
    """A bound socket. Raises PortInUse, or StartError for an address that is not this machine's.

    `verb`: what `make` calls it.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # Named by its protocol, or a plain loop of asyncio leaves Nagle on: the body of an answer then comes 40 ms late.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen(128)
    except OSError as error:
        listening.close()
        if error.errno == errno.EADDRINUSE:
            raise PortInUse(host, port, verb) from None
        raise StartError(f"Cannot listen on {host} port {port}: {error.strerror}.") from error
    return listening


def serve(settings: Settings) -> None:
    """Serve until SIGINT or SIGTERM. Raises StartError before anything has been changed or answered."""
    check_tls(settings)
    with listen(settings.host, settings.port) as listening, the_only_one(settings, ANOTHER_FOLDER):
        asyncio.run(migrate(settings))
        app = create_app(settings, open_clock(settings))
        settle_memory()
        Server(app, config_of(app)).run(sockets=[listening])


def settle_memory() -> None:
    """Exempt what was made so far from garbage collection: looking through it stops everything for 0.1 s each time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(*GARBAGE_AT)


def check_tls(settings: Settings) -> None:
    """Both files or neither, and they fit together. Raises StartError."""
    if (settings.tls_cert is None) != (settings.tls_key is None):
        raise StartError("For https both are needed: --tls-cert and --tls-key.")
    if settings.tls_cert is None:
        return
    try:
        ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(settings.tls_cert, settings.tls_key)
    except OSError as error:  # SSLError is one
        why = "they do not belong together, or one is not PEM" if isinstance(error, ssl.SSLError) else error.strerror
        raise StartError(
            f"The certificate {settings.tls_cert} and the key {settings.tls_key} cannot be used: {why}."
        ) from error


def config_of(app: FastAPI) -> uvicorn.Config:
    """Return the configuration with which uvicorn serves the application."""
    settings = parts_of(app).settings
    return PunctualConfig(
        app,
        within_s=settings.request_within_s,
        log_config=None,
        access_log=False,
        timeout_graceful_shutdown=GRACEFUL_S,
        ws=AttentiveSocket,
        ws_max_size=128 * 1024,
        ws_ping_interval=LOOKS_AFTER_S,
        ws_ping_timeout=ANSWERS_WITHIN_S,
        server_header=False,
        # The proxy ends TLS and says so in X-Forwarded-Proto; no other sender of it is believed.
        proxy_headers=True,
        forwarded_allow_ips=[str(network) for network in settings.trusted_proxies],
        ssl_certfile=settings.tls_cert,
        ssl_keyfile=settings.tls_key,
    )
