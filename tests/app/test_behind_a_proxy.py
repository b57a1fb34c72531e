"""The shipped files of nginx and Caddy, with other addresses and nothing else changed, before the real service.

Neither proxy is needed to develop or to run the service: where one is missing, its test is left out and says so.
"""

import os
import shutil
import socket
import ssl
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.sync.client import connect

from app.core.settings import ROOT
from tests.app.conftest import sqlite_alone
from tests.app.notifications.receivers import certificate
from tests.system.rig import free_port, wait_for
from tests.web.service import Service

PERSON = "ada@campus.example"
# Debian keeps servers where only root's PATH looks.
PATH = f"{os.environ['PATH']}:/usr/sbin:/usr/local/sbin"
TIGHT = {"CAMPUS_MAIL_RATE_LIMITS": '{"enrolment_tries_per_host": "3 per 15 minutes"}'}
NGINX = """daemon off; pid {folder}/pid; error_log {folder}/error.log; worker_processes 1;
events {{ }}
http {{ access_log off; gzip on; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxied;
fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s; include {folder}/site.conf; }}
"""


@dataclass(frozen=True)
class Front:
    """A proxy before the service."""

    url: str
    trust: ssl.SSLContext
    service: Service

    def client(self, **more: Any) -> httpx.Client:
        headers = {"Sec-Fetch-Site": "same-origin"}
        return httpx.Client(base_url=self.url, verify=self.trust, headers=headers, timeout=10, **more)


@pytest.fixture(params=["nginx", "caddy"])
def front(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Front]:
    program = shutil.which(request.param, path=PATH)
    if program is None:
        pytest.skip(f"{request.param} is not installed here")
    data, folder = tmp_path / "data", tmp_path / "proxy"
    data.mkdir()
    folder.mkdir(mode=0o755)
    public, _ = certificate(folder)
    trust = ssl.create_default_context(cafile=public)
    port = free_port()
    with Service(data, more=TIGHT) as service:
        arguments = {"nginx": nginx, "caddy": caddy}[request.param](folder, service.url, port)
        with running([program, *arguments], folder):
            wait_for("the proxy", lambda: is_listening(port), 10)
            yield Front(f"https://127.0.0.1:{port}", trust, service)


def nginx(folder: Path, service: str, port: int) -> list[str]:
    site = (ROOT / "deploy" / "nginx.conf").read_text()
    for shipped, here in (
        ("listen [::]:443 ssl http2;", ""),
        ("listen [::]:80;", ""),
        ("listen 443", f"listen 127.0.0.1:{port}"),
        ("listen 80", f"listen 127.0.0.1:{free_port()}"),
        ("/etc/ssl/certs/mail.campus.example.pem", f"{folder}/server.pem"),
        ("/etc/ssl/private/mail.campus.example.key", f"{folder}/server.key"),
        ("http://127.0.0.1:8000", service),
    ):
        assert shipped in site
        site = site.replace(shipped, here)
    (folder / "site.conf").write_text(site)
    # As root nginx gives its workers to another user, who cannot look into a folder of the tests.
    user = "user root; " if os.geteuid() == 0 else ""
    (folder / "nginx.conf").write_text(user + NGINX.format(folder=folder))
    return ["-p", str(folder), "-c", str(folder / "nginx.conf")]


def caddy(folder: Path, service: str, port: int) -> list[str]:
    site = (ROOT / "deploy" / "Caddyfile").read_text()
    own = f"tls {folder}/server.pem {folder}/server.key"
    for shipped, here in (
        ("\tgrace_period", "\tadmin off\n\tauto_https disable_redirects\n\tskip_install_trust\n\tgrace_period"),
        ("{$CAMPUS_MAIL_PUBLIC_URL:mail.campus.example} {", f"https://127.0.0.1:{port} {{\n\t{own}"),
        ("127.0.0.1:8000", service.removeprefix("http://")),
    ):
        assert shipped in site
        site = site.replace(shipped, here)
    (folder / "Caddyfile").write_text(site)
    return ["run", "--adapter", "caddyfile", "--config", str(folder / "Caddyfile")]


@contextmanager
def running(command: list[str], folder: Path) -> Iterator[None]:
    environment = {"PATH": PATH, "HOME": str(folder), "XDG_DATA_HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
    with (folder / "output").open("wb") as output:
        process = subprocess.Popen(command, env=environment, cwd=folder, stdout=output, stderr=output)
    try:
        yield
    finally:
        process.terminate()
        process.wait(10)


def is_listening(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@sqlite_alone
@pytest.mark.slow
async def test_pages_people_streams_and_robots_come_through_and_no_client_passes_for_another(
    front: Front,
) -> None:
    with front.client() as browser:
        page = browser.get("/")
        assert (page.status_code, page.headers["strict-transport-security"]) == (200, "max-age=31536000")
        assert browser.get("/metrics").status_code == 404
        speaks_http2(front)
        sign_in(browser, front)
        follows_at_once(browser)
        refuses_what_is_too_large_in_its_own_words(browser)
        await lets_robots_in(front)
        knows_who_tries_too_often(front)


def speaks_http2(front: Front) -> None:
    front.trust.set_alpn_protocols(["h2", "http/1.1"])
    address = httpx.URL(front.url)
    plain = socket.create_connection((address.host, address.port or 443))
    with front.trust.wrap_socket(plain, server_hostname=address.host) as spoken:
        assert spoken.selected_alpn_protocol() == "h2"
    front.trust.set_alpn_protocols(["http/1.1"])


def sign_in(browser: httpx.Client, front: Front) -> None:
    browser.post("/api/v1/sign-in/codes", json={"email": PERSON}).raise_for_status()
    signed_in = browser.post("/api/v1/sign-in", json={"email": PERSON, "code": front.service.code_mailed_to(PERSON)})
    cookie = signed_in.raise_for_status().headers["set-cookie"]
    assert cookie.startswith("__Host-session=")
    assert "Secure" in cookie


def follows_at_once(browser: httpx.Client) -> None:
    """An event is on the page when it happens, not when a proxy has a buffer full."""
    with browser.stream("GET", "/api/v1/live") as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        pieces = stream.iter_text()
        assert "following" in next(pieces)
        placed_s = time.monotonic()
        order = {"from_post": "post1", "to_post": "post4", "recipient": "bo@campus.example"}
        placed = browser.post("/api/v1/orders", json=order, headers={"Idempotency-Key": "once"})
        assert placed.status_code == 201, placed.text
        assert "event: order" in next(pieces)
        assert time.monotonic() - placed_s < 2


def refuses_what_is_too_large_in_its_own_words(browser: httpx.Client) -> None:
    refused = browser.post("/api/v1/orders", content=b" " * 100_000, headers={"Content-Type": "application/json"})
    assert (refused.status_code, refused.json()["code"]) == (413, "too_large")


async def lets_robots_in(front: Front) -> None:
    token = await front.service.enrol_robot("r1")
    address = f"{front.url.replace('https', 'wss')}/api/v1/robots/link"
    hello = (ROOT / "protocol" / "examples" / "hello.json").read_text()
    with connect(address, ssl=front.trust, additional_headers={"Authorization": f"Bearer {token}"}) as link:
        link.send(hello)
        assert '"welcome"' in link.recv(timeout=5)


def knows_who_tries_too_often(front: Front) -> None:
    """Each client is counted by its own address, which it cannot choose by a header."""
    wrong = {"name": "r2", "code": "AAAA-AAAA", "public_key": "A" * 43 + "="}

    def tries(client: httpx.Client, said: str) -> int:
        return client.post("/api/v1/robots/enrol", json=wrong, headers={"X-Forwarded-For": said}).status_code

    with (
        front.client() as one,
        front.client(transport=httpx.HTTPTransport(front.trust, local_address="127.0.0.2")) as two,
    ):
        answers = [tries(one, f"192.0.2.{number}") for number in range(4)]
        assert answers[-1] == 429
        assert 429 not in answers[:-1]
        assert tries(two, "192.0.2.9") != 429


@pytest.mark.nightly
def test_another_proxy_is_believed_once_it_is_named_and_only_it(tmp_path: Path) -> None:
    more = TIGHT | {"CAMPUS_MAIL_TRUSTED_PROXIES": '["127.0.0.8/29"]'}
    wrong = {"name": "r2", "code": "AAAA-AAAA", "public_key": "A" * 43 + "="}

    def tries_from(proxy: str, *clients: str) -> list[int]:
        with httpx.Client(base_url=service.url, transport=httpx.HTTPTransport(local_address=proxy)) as client:
            said = ({"X-Forwarded-For": one} for one in clients)
            return [client.post("/api/v1/robots/enrol", json=wrong, headers=one).status_code for one in said]

    clients = [f"192.0.2.{number}" for number in range(4)]
    with Service(tmp_path, more=more) as service:
        assert 429 not in tries_from("127.0.0.9", *clients)
        assert tries_from("127.0.0.9", *["192.0.2.9"] * 4)[-1] == 429
        assert tries_from("127.0.0.1", *clients)[-1] == 429
