"""A campus may sign its service's certificate itself: a robot enrols there once its computer trusts that authority."""

import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

from robot.core.config import ConfigError
from robot.link.enrolment import token_for
from tests.app.notifications.receivers import certificate


class Enrols(BaseHTTPRequestHandler):
    """Answers as the service does to a code that is good."""

    def do_POST(self) -> None:
        self.rfile.read(int(self.headers["Content-Length"]))
        said = json.dumps({"name": "r1", "token": "cmr_01234567_secret"}).encode()
        self.send_response(201)
        self.send_header("Content-Length", str(len(said)))
        self.end_headers()
        self.wfile.write(said)

    def log_message(self, format: str, *args: object) -> None:
        """Nothing: it would go to stderr."""


@pytest.fixture
def service(tmp_path: Path) -> Iterator[tuple[str, Path]]:
    public, tls = certificate(tmp_path)
    with HTTPServer(("127.0.0.1", 0), Enrols) as server:
        server.socket = tls.wrap_socket(server.socket, server_side=True)
        thread = threading.Thread(target=server.serve_forever, args=(0.05,))
        thread.start()
        try:
            yield f"wss://127.0.0.1:{server.server_port}/api/v1/robots/link", public
        finally:
            server.shutdown()
            thread.join()


def test_a_robot_enrols_where_its_computer_trusts_the_campuss_own_authority_and_says_why_elsewhere(
    service: tuple[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    link, authority = service
    with pytest.raises(ConfigError, match=r"certificate verify failed.*Check the network"):
        token_for("ABCD-EFGH", "r1", link, "key")
    monkeypatch.setenv("SSL_CERT_FILE", str(authority))
    assert token_for("ABCD-EFGH", "r1", link, "key") == "cmr_01234567_secret"
