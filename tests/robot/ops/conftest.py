"""Fixtures that several of these tests share."""

import http
import json
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from websockets.sync.server import ServerConnection, serve

from maps import find_map


@pytest.fixture
def link() -> Iterator[str]:
    """A service that takes the token `good` and hangs up on others as the real one does; it tells its map, too."""

    def talk(socket: ServerConnection) -> None:
        assert socket.request
        if socket.request.headers.get("Authorization") == "Bearer good":
            for _ in socket:
                pass
        else:
            socket.close(4401, "token refused")

    def answer(connection: ServerConnection, request: Any) -> Any:
        if request.path.endswith("/map"):
            campus = find_map("test_track")
            return connection.respond(http.HTTPStatus.OK, json.dumps({"name": campus.name, "version": campus.version}))
        return None

    with serve(talk, "127.0.0.1", 0, process_request=answer) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}/api/v1/robots/link"
        server.shutdown()
        thread.join()
