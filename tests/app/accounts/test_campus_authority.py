"""A campus may sign the certificates of its own servers: what the operator has set is reached by whom the machine
trusts, and what people give us by the public authorities alone."""

import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import httpx
import pytest

from app.accounts.errors import ProviderFailed
from app.accounts.sign_in.oidc import Provider
from app.core.http_client import trusted, trusted_here
from app.core.server_key import ServerKey
from app.core.settings import Settings
from tests.app.notifications.receivers import certificate


class Describes(BaseHTTPRequestHandler):
    """A provider that says what it is."""

    def do_GET(self) -> None:
        issuer = f"https://127.0.0.1:{self.server.server_address[1]}"
        said = json.dumps({"issuer": issuer, "jwks_uri": f"{issuer}/keys"}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(said)))
        self.end_headers()
        self.wfile.write(said)

    def log_message(self, format: str, *args: object) -> None:
        """Nothing: it would go to stderr."""


@pytest.fixture
def campus(tmp_path: Path) -> Iterator[tuple[str, Path]]:
    public, tls = certificate(tmp_path)
    with HTTPServer(("127.0.0.1", 0), Describes) as server:
        server.socket = tls.wrap_socket(server.socket, server_side=True)
        thread = threading.Thread(target=server.serve_forever, args=(0.05,))
        thread.start()
        try:
            yield f"https://127.0.0.1:{server.server_port}", public
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture
def read_anew() -> Iterator[None]:
    """Authorities are read once for the life of a process."""
    trusted_here.cache_clear()
    yield
    trusted_here.cache_clear()


@pytest.mark.usefixtures("read_anew")
async def test_the_campuss_own_sign_in_is_asked_if_the_machine_trusts_its_authority(
    campus: tuple[str, Path], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    issuer, authority = campus
    set_so = settings.model_copy(update={"oidc_issuer": issuer, "oidc_client_id": "campus-mail"})
    with pytest.raises(ProviderFailed):
        await Provider(set_so, ServerKey(bytes(32))).about()
    monkeypatch.setenv("SSL_CERT_FILE", str(authority))
    trusted_here.cache_clear()
    assert (await Provider(set_so, ServerKey(bytes(32))).about())["issuer"] == issuer
    async with httpx.AsyncClient(verify=trusted(), trust_env=False) as of_people:
        with pytest.raises(httpx.ConnectError):
            await of_people.get(issuer)
