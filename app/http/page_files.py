"""Files of the pages, and a version that changes with any of them: the service worker keeps these files.

Some are put together here, so that a first page asks for less: the styles of every page in one file, and the texts
without those that only some pages or only mails have.
"""

import asyncio
import json
from collections.abc import Awaitable, Callable, Iterator, Mapping
from functools import partial
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Final

from fastapi import FastAPI, Request
from fastapi.responses import Response

from app.core.errors import problem_answer
from app.core.texts import LANGUAGES

MODULE: Final = "/src/offline/page_files.js"
WORKER: Final = "/service_worker.js"
STYLES: Final = "/src/styles/everywhere.css"
STYLES_OF: Final = ("tokens", "base", "shell", "controls")
TEXTS: Final = "/src/texts/{language}.{pages}.json"
IN_NEITHER: Final = frozenset({"email", "notice", "robots", "mind", "sensor", "settings"})
LEFT_OUT: Final[Mapping[str, frozenset[str]]] = {
    "everyday": IN_NEITHER | {"mailroom", "print", "alarm"},
    "mailroom": IN_NEITHER
    | {"code", "delegate", "estimate", "follow", "mail", "next", "one_order", "quality", "stage", "state"},
}
"""By kind of page, as `texts.js` names them, the families of texts that are for others and for mails; a test says if a
page needs one that it is not sent."""
CATALOGUES: Final = tuple(product(LANGUAGES, LEFT_OUT))
JSON: Final = "application/json"
KEPT: Final = frozenset({".html", ".js", ".css", ".json", ".svg"})
"""Pictures of the app for the home screen are fetched by the system once, not by pages."""
NPM_MODULES: Final = "npm_modules.json"
VERSION_CHARACTERS: Final = 16


class PageFiles:
    """The files of one folder. They are read again when one of them was written: who edits pages restarts nothing."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._seen: dict[str, int] = {}
        self._module = b""

    def module(self) -> bytes:
        """A module that names the files and their version."""
        files = dict(sorted(self._files()))
        seen = {address: path.stat().st_mtime_ns for address, path in files.items()}
        if seen != self._seen or not self._module:
            self._module, self._seen = self._written(files), seen
        return self._module

    def worker(self) -> bytes:
        """The service worker of this version: browsers look at it anew when its own bytes have changed."""
        version = self.module().partition(b"\n")[0]
        return (self._folder / "public" / WORKER[1:]).read_bytes() + b"// " + version + b"\n"

    def styles(self) -> bytes:
        """The styles that every page has."""
        return b"\n".join((self._folder / f"src/styles/{name}.css").read_bytes() for name in STYLES_OF)

    def texts(self, language: str, pages: str) -> bytes:
        """The texts of one language that these pages use."""
        texts = json.loads((self._folder / f"src/texts/{language}.json").read_bytes())
        used = {key: text for key, text in texts.items() if key.partition(".")[0] not in LEFT_OUT[pages]}
        return json.dumps(used, ensure_ascii=False, separators=(",", ":")).encode()

    def _files(self) -> Iterator[tuple[str, Path]]:
        for address in ("/", "/src/"):
            root = self._folder / (address.strip("/") or "public")
            for path in root.rglob("*"):
                place = path.relative_to(root).as_posix()
                if path.suffix in KEPT and place != WORKER[1:]:
                    yield "/" if place == "index.html" else address + place, path
        listed = self._folder / NPM_MODULES
        for address in json.loads(listed.read_text(encoding="utf-8")) if listed.is_file() else ():
            path = self._folder / address.replace("/npm/", "node_modules/", 1)
            if path.is_file():
                yield address, path

    def _written(self, files: dict[str, Path]) -> bytes:
        version = sha256()
        for address, path in files.items():
            version.update(address.encode() + b"\0" + sha256(path.read_bytes()).digest())
        parts = {f"/src/styles/{name}.css" for name in STYLES_OF}
        made = [STYLES, *(TEXTS.format(language=language, pages=pages) for language, pages in CATALOGUES)]
        addresses = json.dumps([*(address for address in files if address not in parts), *made])
        name = json.dumps(version.hexdigest()[:VERSION_CHARACTERS])
        return f"export const VERSION = {name};\nexport const FILES = {addresses};\n".encode()


def add_page_files(app: FastAPI, files: PageFiles) -> None:
    """Serve what is not simply a file of the folder."""
    made: tuple[tuple[str, str, Callable[[], bytes]], ...] = (
        (MODULE, "text/javascript", files.module),
        (WORKER, "text/javascript", files.worker),
        (STYLES, "text/css", files.styles),
        *(
            (TEXTS.format(language=one, pages=pages), JSON, partial(files.texts, one, pages))
            for one, pages in CATALOGUES
        ),
    )
    for address, media_type, read in made:
        app.get(address, include_in_schema=False)(_made(media_type, read))


def _made(media_type: str, read: Callable[[], bytes]) -> Callable[[Request], Awaitable[Response]]:
    async def made(request: Request) -> Response:
        try:
            content = await asyncio.to_thread(read)
        except FileNotFoundError:
            return problem_answer(404, "not_found", "This service has no such pages.")
        tag = f'"{sha256(content).hexdigest()[:VERSION_CHARACTERS]}"'
        if tag in request.headers.get("if-none-match", ""):
            return Response(status_code=304, headers={"ETag": tag})
        return Response(content, media_type=media_type, headers={"ETag": tag})

    return made
