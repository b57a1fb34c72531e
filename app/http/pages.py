"""Serves the pages of `web/` and what they use from npm, with the headers that keep them safe and fresh."""

import base64
import os
import re
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import Final

import structlog
from fastapi import FastAPI
from starlette.datastructures import Headers, MutableHeaders
from starlette.routing import Match, Mount
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.compressed_pages import Compressed
from app.http.page_files import WORKER, PageFiles, add_page_files

log = structlog.get_logger(__name__)

NPM_PACKAGES: Final = ("joined", "lit-html")
"""What browsers may fetch of node_modules."""
PARTS_OF_A_PAGE: Final = frozenset({"text/javascript", "text/css"})
"""What says nothing by itself: the page that asks for it has said what it may do. A page has dozens of them."""
SAME_FOR_EVERYBODY: Final = "/api/v1/map"
"""No secret is in it and nothing that anybody sent."""
DATA: Final = frozenset({"application/json", "application/problem+json", "text/event-stream"})
"""What is no document: opened as one, it may do nothing at all."""
OF_EVERY_ANSWER: Final = {"X-Content-Type-Options": "nosniff", "Cache-Control": "no-cache"}
OF_DATA: Final = OF_EVERY_ANSWER | {"Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'"}
IMPORT_MAP = re.compile(rb'<script type="importmap">(.*?)</script>', re.DOTALL)


def add_pages(app: FastAPI, folder: Path) -> None:
    """Serve of `folder`: `public/` at `/`, `src/` at `/src/`, the packages at `/npm/`. Routes that are added afterwards
    come after them: a first page asks for dozens of files, and each would be compared with every route of the API
    first, which took half of its time.
    """
    for package in NPM_PACKAGES:
        package_folder = folder / "node_modules" / package
        if package_folder.is_dir():
            app.mount(f"/npm/{package}", StaticFiles(directory=package_folder))
        else:
            log.warning("the pages lack a package: run `make setup`", package=package)
    if folder.is_dir():
        add_page_files(app, PageFiles(folder))
        app.mount("/src", StaticFiles(directory=folder / "src"))
        app.router.routes.append(Pages(folder / "public"))
    else:
        log.warning("there are no pages", folder=str(folder))


class Pages(Mount):
    """The files of a folder, at `/` beside the API: what begins with no name that is in the folder is not theirs."""

    def __init__(self, folder: Path) -> None:
        super().__init__("/", StaticFiles(directory=folder, html=True))
        self._folder = folder

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        name = scope["path"].strip("/").partition("/")[0]
        # Path.exists() raises where a name is too long.
        if scope["type"] != "http" or not os.path.exists(self._folder / name):  # noqa: PTH110
            return Match.NONE, {}
        return super().matches(scope)


def import_map_hashes(pages: Iterable[Path]) -> list[str]:
    """The inline import maps, the only scripts that may stand in a page, as CSP sources."""
    maps = {found for page in pages for found in IMPORT_MAP.findall(page.read_bytes())}
    return sorted(f"'sha256-{base64.b64encode(sha256(one).digest()).decode()}'" for one in maps)


def content_security_policy(folder: Path) -> str:
    """Everything from here, nothing inline but the import maps, framed by no other page."""
    hashes = " ".join(import_map_hashes(folder.glob("public/*.html")))
    return (
        f"default-src 'self'; script-src 'self' {hashes}; img-src 'self' data:; object-src 'none'; "
        "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    )


class CompressedPages:
    """Compresses pages.

    The API is left as it is, but for the map: its answers hold secrets next to what others wrote, which a compressed
    length gives away bit by bit (BREACH), and its event stream must not be held back. Ranges are of the file as it lies
    on the disk.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._plain, self._compressed = app, Compressed(app)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http" and _may_be_compressed(scope):
            await self._compressed(scope, receive, send)
        else:
            await self._plain(scope, receive, send)


def _may_be_compressed(scope: Scope) -> bool:
    is_private = scope["path"].startswith("/api/") and scope["path"] != SAME_FOR_EVERYBODY
    return not is_private and "range" not in Headers(scope=scope)


class SafeHeaders:
    """Adds to every answer what browsers are to be strict about. Nothing is used again without asking first."""

    def __init__(self, app: ASGIApp, policy: str) -> None:
        self._app = app
        self._of_documents = OF_EVERY_ANSWER | {
            "Content-Security-Policy": policy,
            "Referrer-Policy": "same-origin",
            "Cross-Origin-Opener-Policy": "same-origin",
            "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
        }

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def send_safely(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in self._strict(scope["path"], headers.get("content-type", "")).items():
                    headers.setdefault(name, value)
                if scope["scheme"] == "https":
                    headers.setdefault("Strict-Transport-Security", "max-age=31536000")
            await send(message)

        await self._app(scope, receive, send_safely)

    def _strict(self, path: str, content_type: str) -> dict[str, str]:
        kind = content_type.partition(";")[0]
        if kind in PARTS_OF_A_PAGE and path != WORKER:
            return OF_EVERY_ANSWER
        return OF_DATA if kind in DATA else self._of_documents
