"""The door of a simulated robot, as far as the pages use it: what people hold to its camera."""

import asyncio
import json
import uuid
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path


class Camera:
    """Listens at `door` and remembers every code it is shown."""

    def __init__(self) -> None:
        self.door = Path(f"/tmp/campus-mail-pages-{uuid.uuid4().hex[:12]}")  # socket paths are short
        self._seen: asyncio.Queue[str] = asyncio.Queue()

    @asynccontextmanager
    async def watching(self) -> AsyncIterator["Camera"]:
        server = await asyncio.start_unix_server(self._answer, self.door)
        try:
            yield self
        finally:
            server.close()
            await server.wait_closed()
            self.door.unlink(missing_ok=True)

    async def _answer(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        wish = json.loads(await reader.readline())
        if wish["do"] == "show_code":
            self._seen.put_nowait(wish["text"])
        writer.write(json.dumps({"ok": wish["do"] == "show_code", "error": "unknown wish"}).encode() + b"\n")
        await writer.drain()
        writer.close()
        await writer.wait_closed()

    async def sees(self) -> str:
        """The next code that is shown to the camera."""
        async with asyncio.timeout(10):
            return await self._seen.get()
