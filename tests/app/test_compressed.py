"""The cache of compressed answers."""

import gzip
from pathlib import Path

import pytest
from starlette.staticfiles import StaticFiles
from starlette.types import Message

from app.http.compressed_pages import Compressed

FILE = "export const letters = 1;\n" * 100
SPELLINGS = ["/parts/file.js", "/parts/./file.js", "//parts//file.js", "/x/../parts/file.js", "/parts/file.js/"]


@pytest.fixture
def pages(tmp_path: Path) -> Compressed:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/file.js").write_text(FILE)
    return Compressed(StaticFiles(directory=tmp_path))


async def test_a_file_is_kept_once_however_its_path_is_spelled(pages: Compressed) -> None:
    """Else a client that spells it anew each time would have the service compress its best, and keep all of it."""
    for path in SPELLINGS:
        assert gzip.decompress(await answered(pages, path)).decode() == FILE
    assert len(pages.kept) == 1


async def answered(pages: Compressed, path: str) -> bytes:
    """The body as it goes over the wire. Asked as a stranger does: clients would put the path in its plain form."""
    body: list[bytes] = []

    async def send(message: Message) -> None:
        body.append(message.get("body", b""))

    async def receive() -> Message:
        raise AssertionError("nothing else is asked")

    asked = {"type": "http", "method": "GET", "path": path, "headers": [(b"accept-encoding", b"gzip")]}
    await pages({**asked, "asgi": {"spec_version": "2.4"}}, receive, send)
    return b"".join(body)
