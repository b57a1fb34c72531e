"""Addresses that people give us for push and webhooks lead to the public network or nowhere."""

import ipaddress
import ssl
import subprocess
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from ipaddress import ip_network
from pathlib import Path
from typing import ClassVar

import httpx
import pytest

from app.composition import create_app
from app.core.errors import StartError
from app.core.http_client import HttpClient, Resolve, TargetRefused
from app.core.settings import load_settings
from app.core.special_networks import SPECIAL_IPV4, SPECIAL_IPV6, Network, is_public
from protocol.clock import SteppedClock

NETWORKS_OF_PYTHON = [
    *ipaddress._IPv4Constants._private_networks,  # type: ignore[attr-defined]
    *ipaddress._IPv6Constants._private_networks,  # type: ignore[attr-defined]
]
"""A second witness, which no person here has typed."""

INSIDE = [
    "127.0.0.1",
    "0.0.0.0",  # noqa: S104  # nothing is bound
    "10.1.2.3",
    "172.16.0.1",
    "192.168.1.1",
    "100.64.0.1",
    "169.254.169.254",  # where clouds keep the machine's credentials
    "192.0.0.8",  # dummy
    "192.0.0.170",  # discovery of NAT64
    "192.0.2.1",
    "192.88.99.1",  # 6to4 relays
    "198.18.0.1",
    "198.19.255.255",
    "198.51.100.1",
    "203.0.113.1",
    "224.0.0.1",
    "239.255.255.250",
    "240.0.0.1",
    "255.255.255.255",
    "::1",
    "::",
    "::10.1.2.3",  # IPv4-compatible
    "::93.184.216.34",
    "fe80::1",
    "fe80::1%eth0",
    "2606:2800:220:1::1%eth0",
    "fec0::1",  # site local
    "fd00:ec2::254",
    "ff02::1",
    "ff0e::1",  # multicast everywhere
    "100::1",  # discarded
    "5f00::1",  # segment routing
    "64:ff9b:1::a01:203",  # NAT64 of one's own
    "64:ff9b::7f00:1",
    "64:ff9b::a01:203",
    "64:ff9b::c000:8",
    "::ffff:127.0.0.1",
    "::ffff:169.254.169.254",
    "::ffff:0:10.1.2.3",  # IPv4-translated
    "2001::f5ff:fffe",  # Teredo, to 10.0.0.1
    "2001:0:4136:e378:8000:63bf:3fff:fdd2",
    "2001:2::1",  # benchmarks
    "2001:10::1",  # ORCHID
    "2001:20::1",
    "2001:db8::1",
    "2002:7f00:1::",  # 6to4, to 127.0.0.1
    "2002:a01:203::1",
    "2002:5db8:d822::1",
    "3fff::1",
    "3ffe::1",
    "4000::1",  # not given out
]


@pytest.mark.parametrize("address", INSIDE)
def test_an_address_inside_is_not_public(address: str) -> None:
    assert not is_public(address)


OUTSIDE = ["93.184.216.34", "2606:2800:220:1::1", "2a00:1450::1", "::ffff:93.184.216.34", "64:ff9b::5db8:d822"]


@pytest.mark.parametrize("address", OUTSIDE)
def test_an_address_of_the_network_is_public(address: str) -> None:
    assert is_public(address)


@pytest.mark.parametrize("networks", [*NETWORKS_OF_PYTHON, *SPECIAL_IPV4, *SPECIAL_IPV6], ids=str)
def test_what_python_knows_of_the_registries_is_refused_from_the_first_address_to_the_last(networks: Network) -> None:
    assert not is_public(str(networks[0]))
    assert not is_public(str(networks[-1]))


@pytest.mark.parametrize("address", OUTSIDE)
def test_the_operator_refuses_networks_of_the_campus_however_they_are_written(address: str) -> None:
    campus = [ip_network(one) for one in ("93.184.0.0/16", "2606:2800::/32", "2a00:1450::1/128", "64:ff9b::/96")]
    assert not is_public(address, campus)
    assert is_public("9.9.9.9", campus)


def always(*addresses: str) -> Resolve:
    async def resolve(host: str, port: int) -> list[str]:
        return list(addresses)

    return resolve


@pytest.mark.parametrize(
    "url", ["https://hooks.example:22/", "https://hooks.example:8443/", "https://hooks.example:0/"]
)
async def test_443_is_asked_alone_unless_the_operator_allows_another_port(url: str) -> None:
    http_client = HttpClient(resolve=always("93.184.216.34"))
    assert (await http_client.checked_target("https://hooks.example/")).port == 443
    assert (await http_client.checked_target("https://hooks.example:443/")).port == 443
    with pytest.raises(TargetRefused, match="among those that may be asked: 443"):
        await http_client.checked_target(url)
    more = HttpClient((443, 8443), resolve=always("93.184.216.34"))
    assert (await more.checked_target("https://hooks.example:8443/")).port == 8443


async def test_the_settings_open_ports_and_refuse_networks(
    tmp_path: Path, clock: SteppedClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path))
    monkeypatch.setenv("CAMPUS_MAIL_OUTSIDE_PORTS", "[443, 8443]")
    monkeypatch.setenv("CAMPUS_MAIL_OUTSIDE_REFUSED_NETWORKS", '["93.184.0.0/16"]')
    http_client: HttpClient = create_app(load_settings(), clock).state.parts.http_client
    assert (await http_client.checked_target("https://9.9.9.9:8443/")).address == "9.9.9.9"
    with pytest.raises(TargetRefused, match="not on the public network"):
        await http_client.checked_target("https://93.184.216.34/")


@pytest.mark.parametrize(("name", "value"), [("PORTS", "[0]"), ("PORTS", "[]"), ("REFUSED_NETWORKS", '["10.0.0.1/8"]')])
def test_ports_and_networks_that_are_none_keep_the_service_from_starting(
    name: str, value: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(f"CAMPUS_MAIL_OUTSIDE_{name}", value)
    with pytest.raises(StartError, match=f"CAMPUS_MAIL_OUTSIDE_{name}"):
        load_settings()


async def test_a_name_is_looked_up_as_it_travels() -> None:
    """Two standards read ß differently: what is looked up is what the certificate is asked for."""
    asked = []

    async def resolve(host: str, port: int) -> list[str]:
        asked.append(host)
        return ["93.184.216.34"]

    target = await HttpClient(resolve=resolve).checked_target("https://straße.example./")
    assert asked == ["xn--strae-oqa.example."]
    assert target.host == "xn--strae-oqa.example"


@pytest.mark.parametrize(
    "url",
    [
        "http://hooks.example/",
        "ftp://hooks.example/",
        "file:///etc/passwd",
        "https://",
        "https://ada:secret@hooks.example/",
        "https://[::1/",
        "https://127.0.0.1/",
        "https://2130706433/",  # 127.0.0.1 as one number
        "https://0x7f.1/",
        "https://[::1]/",
        "https://localhost/",
        "https://①②⑦.⓪.⓪.①/",
        "https://hooks.example\\@127.0.0.1/",
        "https://127.0.0.1./",
        "https://[fe80::1%25eth0]/",
        "https://[::ffff:10.1.2.3]/",
        "https://nowhere.invalid/",
        "nonsense",
    ],
)
async def test_an_address_that_leads_inside_or_nowhere_is_refused(url: str) -> None:
    with pytest.raises(TargetRefused):
        await HttpClient().checked_target(url)


async def test_one_address_inside_among_many_is_enough_to_refuse_a_name() -> None:
    async def mixed(host: str, port: int) -> list[str]:
        return ["93.184.216.34", "10.0.0.1"]

    with pytest.raises(TargetRefused, match="not on the public network"):
        await HttpClient(resolve=mixed).checked_target("https://hooks.example/")


async def test_a_name_that_was_outside_yesterday_is_refused_when_it_leads_inside_today() -> None:
    answers = [["93.184.216.34"], ["127.0.0.1"]]

    async def changing(host: str, port: int) -> list[str]:
        return answers.pop(0)

    http_client = HttpClient(resolve=changing)
    assert (await http_client.checked_target("https://hooks.example/")).address == "93.184.216.34"
    async with http_client.client() as client:
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

    async with HttpClient(allow_private=True, resolve=once).client() as client:
        answer = await client.post(f"http://hooks.example:{hook}/here")
    assert answer.status_code == 204
    assert asked == ["hooks.example"], "no name server was asked a second time"
    assert Hook.asked == [(f"hooks.example:{hook}", "/here")]


async def test_a_redirect_is_checked_like_any_request(hook: int) -> None:
    async def only_the_hook(host: str, port: int) -> list[str]:
        if host != "hooks.example":
            raise OSError("there is no such name")
        return ["127.0.0.1"]

    async with HttpClient(allow_private=True, resolve=only_the_hook).client() as client:
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
        async with HttpClient(allow_private=True, resolve=here).client() as client:
            with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
                await client.post(f"https://hooks.example:{server.server_port}/")
        server.shutdown()
        thread.join()
    assert names == ["hooks.example"]
