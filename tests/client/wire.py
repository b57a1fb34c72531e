"""A wire between client and service that breaks in the middle of what it carries."""

import asyncio
import contextlib
from collections.abc import AsyncIterator, Iterable
from contextlib import asynccontextmanager


class BreakingWire:
    """Forwards to `target_port`. The n-th connection breaks after `breaks[n]` bytes to the client; later ones hold."""

    def __init__(self, target_port: int, breaks: Iterable[int] = ()) -> None:
        self.target_port, self.port = target_port, 0
        self.connections = 0
        self._breaks = iter(breaks)
        self._writers: set[asyncio.StreamWriter] = set()

    @asynccontextmanager
    async def laid(self) -> AsyncIterator["BreakingWire"]:
        """Listening on a port of its own."""
        server = await asyncio.start_server(self._serve, "127.0.0.1", 0)
        self.port = server.sockets[0].getsockname()[1]
        try:
            yield self
        finally:
            server.close()
            self.break_all()

    def break_all(self) -> None:
        """Everything that is open now."""
        for writer in list(self._writers):
            writer.transport.abort()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.connections += 1
        left_bytes = next(self._breaks, None)
        self._writers.add(writer)
        with contextlib.suppress(OSError):
            far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self.target_port)
            self._writers.add(far_writer)
            upwards = asyncio.create_task(self._copy(reader, far_writer, None))
            await self._copy(far_reader, writer, left_bytes)
            for end in (writer, far_writer):
                end.transport.abort()
            await upwards
        writer.transport.abort()

    async def _copy(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, left_bytes: int | None) -> None:
        with contextlib.suppress(OSError):
            while data := await reader.read(65536):
                writer.write(data if left_bytes is None else data[:left_bytes])
                await writer.drain()
                if left_bytes is not None and (left_bytes := left_bytes - len(data)) <= 0:
                    return
