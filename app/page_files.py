"""What the pages are made of, and a version that changes with any of it: the service worker keeps these files."""

import asyncio
import json
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Final

from fastapi import FastAPI
from fastapi.responses import Response

ADDRESS: Final = "/page_files.js"
KEPT: Final = frozenset({".html", ".js", ".css", ".json", ".svg"})
"""Pictures of the app for the home screen are fetched by the system once, not by pages."""
WORKER: Final = "/service_worker.js"
NPM_MODULES: Final = "npm_modules.json"
VERSION_CHARACTERS: Final = 16


class PageFiles:
    """The files of one folder. They are read again when one of them was written: who edits pages restarts nothing."""

    def __init__(self, folder: Path, not_pages: frozenset[str]) -> None:
        self._folder, self._not_pages = folder, not_pages
        self._seen: dict[str, int] = {}
        self._module = b""

    def module(self) -> bytes:
        """A module that names the files and their version."""
        files = dict(sorted(self._files()))
        seen = {address: path.stat().st_mtime_ns for address, path in files.items()}
        if seen != self._seen or not self._module:
            self._module, self._seen = _written(files), seen
        return self._module

    def worker(self) -> bytes:
        """The service worker of this version."""
        version = self.module().partition(b"\n")[0]
        return (self._folder / WORKER[1:]).read_bytes() + b"// " + version + b"\n"

    def _files(self) -> Iterator[tuple[str, Path]]:
        for path in self._folder.rglob("*"):
            place = path.relative_to(self._folder)
            if place.parts[0] in self._not_pages or path.suffix not in KEPT or place.name == WORKER[1:]:
                continue
            yield "/" if str(place) == "index.html" else f"/{place.as_posix()}", path
        for address in json.loads((self._folder / NPM_MODULES).read_text(encoding="utf-8")):
            path = self._folder / address.replace("/npm/", "node_modules/", 1)
            if path.is_file():
                yield address, path


def _written(files: dict[str, Path]) -> bytes:
    version = sha256()
    for address, path in files.items():
        version.update(address.encode() + b"\0" + sha256(path.read_bytes()).digest())
    name = version.hexdigest()[:VERSION_CHARACTERS]
    return f"export const VERSION = {json.dumps(name)};\nexport const FILES = {json.dumps(list(files))};\n".encode()


def add_page_files(app: FastAPI, files: PageFiles) -> None:
    """Serve the module that names them, and the worker, whose own bytes must change for browsers to look at it anew."""

    @app.get(ADDRESS, include_in_schema=False)
    async def page_files() -> Response:
        return Response(await asyncio.to_thread(files.module), media_type="text/javascript")

    @app.get(WORKER, include_in_schema=False)
    async def service_worker() -> Response:
        return Response(await asyncio.to_thread(files.worker), media_type="text/javascript")
