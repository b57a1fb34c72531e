"""Addresses that people give us for push and webhooks lead to the public network or nowhere."""

import ssl
import subprocess
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import ClassVar

import httpx
import pytest

from app.outside import Outside, TargetRefused, is_public

INSIDE = [
    "127.0.0.1",
    "0.0.0.0",  # noqa: S104  # nothing is bound
    "10.1.2.3",
    "172.16.0.1",
    "192.168.1.1",
    "100.64.0.1",
    "169.254.169.254",  # where clouds keep the machine's credentials
    "224.0.0.1",
    "::1",
    "::",
    "fe80::1%eth0",
    "fd00:ec2::254",
    "ff02::1",
    "::ffff:127.0.0.1",
    "64:ff9b::7f00:1",
    "2002:7f00:1::",
]


@pytest.mark.parametrize("address", INSIDE)
def test_an_address_inside_is_not_public(address: str) -> None:
    assert not is_public(address)


@pytest.mark.parametrize("address", ["93.184.216.34", "2606:2800:220:1::1", "::ffff:93.184.216.34"])
def test_an_address_of_the_network_is_public(address: str) -> None:
    assert is_public(address)


@pytest.mark.parametrize(
    "url",
    [
        "http://hooks.example/",
        "ftp://hooks.example/",
        "file:///etc/passwd",
        "https://",
        "https://somebody:secret@hooks.example/",
        "https://[::1/",
        "https://127.0.0.1/",
        "https://2130706433/",  # 127.0.0.1 as one number
        "https://0x7f.1/",
        "https://[::1]/",
        "https://localhost/",
        "https://nowhere.invalid/",
        "nonsense",
    ],
)
async def test_an_address_that_leads_inside_or_nowhere_is_refused(url: str) -> None:
    with pytest.raises(TargetRefused):
        await Outside().checked_target(url)


async def test_one_address_inside_among_many_is_enough_to_refuse_a_name() -> None:
    async def mixed(host: str, port: int) -> list[str]:
        return ["93.184.216.34", "10.0.0.1"]

    with pytest.raises(TargetRefused, match="not on the public network"):
        await Outside(resolve=mixed).checked_target("https://hooks.example/")


async def test_a_name_that_was_outside_yesterday_is_refused_when_it_leads_inside_today() -> None:
    answers = [["93.184.216.34"], ["127.0.0.1"]]

    async def changing(host: str, port: int) -> list[str]:
        return answers.pop(0)

    outside = Outside(resolve=changing)
    assert (await outside.checked_target("https://hooks.example/")).address == "93.184.216.34"
    async with outside.client() as client:
        with pytest.raises(TargetRefused):
            await client.post("https://hooks.example/")


class Hook(BaseHTTPRequestHandler):
    """Writes down who was asked for; /away sends elsewhere."""

    asked: ClassVar[list[tuple[str, str]]] = []

    def do_POST(self) -> None:
        self.asked.append((self.headers["Host"], self.path))
        self.send_response(307 if self.path == "/away" else 204)
        if self.path == "/away":
            self.send_header("Location", "https://metadata.example/latest")
        self.end_headers()

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def hook() -> Iterator[int]:
    Hook.asked.clear()
    with ThreadingHTTPServer(("127.0.0.1", 0), Hook) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server.server_port
        server.shutdown()
        thread.join()


async def test_the_connection_goes_to_the_address_that_was_checked(hook: int) -> None:
    asked = []

    async def once(host: str, port: int) -> list[str]:
        asked.append(host)
        return ["127.0.0.1"]

    async with Outside(allow_private=True, resolve=once).client() as client:
        answer = await client.post(f"http://hooks.example:{hook}/here")
    assert answer.status_code == 204
    assert asked == ["hooks.example"], "no name server was asked a second time"
    assert Hook.asked == [(f"hooks.example:{hook}", "/here")]


async def test_a_redirect_is_checked_like_any_request(hook: int) -> None:
    async def only_the_hook(host: str, port: int) -> list[str]:
        if host != "hooks.example":
            raise OSError("there is no such name")
        return ["127.0.0.1"]

    async with Outside(allow_private=True, resolve=only_the_hook).client() as client:
        with pytest.raises(TargetRefused, match=r"metadata\.example"):
            await client.post(f"http://hooks.example:{hook}/away", follow_redirects=True)
        assert (await client.post(f"http://hooks.example:{hook}/away")).status_code == 307, "not followed unasked"


@pytest.fixture
def anothers_certificate(tmp_path: Path) -> Path:
    """Key and certificate of other.example, signed by itself."""
    key, certificate = tmp_path / "key.pem", tmp_path / "certificate.pem"
    made = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]
    made += ["-days", "2", "-subj", "/CN=other.example", "-keyout", str(key), "-out", str(certificate)]
    subprocess.run(made, check=True, capture_output=True)
    certificate.write_text(key.read_text() + certificate.read_text())
    return certificate


async def test_tls_is_for_the_name_and_not_for_the_address(anothers_certificate: Path) -> None:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(anothers_certificate)
    names: list[str | None] = []
    context.sni_callback = lambda _socket, name, _context: names.append(name)

    async def here(host: str, port: int) -> list[str]:
        return ["127.0.0.1"]

    with ThreadingHTTPServer(("127.0.0.1", 0), Hook) as server:
        server.socket = context.wrap_socket(server.socket, server_side=True)
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        async with Outside(allow_private=True, resolve=here).client() as client:
            with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
                await client.post(f"https://hooks.example:{server.server_port}/")
        server.shutdown()
        thread.join()
    assert names == ["hooks.example"]
