"""A client that connects and says nothing, or half of something, is cut off; slow but honest clients are not.

The service is a real process, once over plain http and once with a certificate of its own.
"""

import json
import socket
import ssl
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
from websockets.sync.client import ClientConnection
from websockets.sync.client import connect as connect_websocket

from app.accounts.sessions.sessions import new_session
from app.accounts.sign_in.service import make_person
from app.core.database.database import Database
from app.core.settings import Settings
from app.robots.service import enrol
from protocol.clock import RealClock
from tests.app.conftest import SENDER, sqlite_alone
from tests.app.notifications.receivers import certificate
from tests.app.notifications.test_killed_while_sending import free_port
from tests.app.service_process import said, serving
from tests.app.test_stop import HELLO

WITHIN_S = 4.0
LATE_S = 12.0
"""On a machine that is busy with other tests."""
pytestmark = sqlite_alone

HEAD = b"POST /api/v1/sign-in HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
BODY = json.dumps({"email": SENDER, "code": "00000000"}).encode()
WHOLE = HEAD + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY


@dataclass(frozen=True)
class Door:
    """The service at its port; `trust` if it speaks TLS."""

    port: int
    trust: ssl.SSLContext | None
    robot_token: str
    cookie: str

    @property
    def scheme(self) -> str:
        return "https" if self.trust else "http"

    @contextmanager
    def knock(self) -> Iterator[socket.socket]:
        """A connection on which nothing has been said, but for the handshake."""
        with self.raw() as plain:
            if self.trust is None:
                yield plain
            else:
                with self.trust.wrap_socket(plain, server_hostname="127.0.0.1") as wrapped:
                    yield wrapped

    def raw(self) -> socket.socket:
        return socket.create_connection(("127.0.0.1", self.port), timeout=LATE_S)


async def _admitted(settings: Settings) -> tuple[str, str]:
    """A robot's token, and the cookie of a person's session."""
    database, clock = Database(settings.url_of_database), RealClock()
    try:
        async with database.transaction() as session:
            person = make_person(SENDER, "en", clock.utc())
            row, cookie = new_session(person, "", 3600, clock.utc())
            session.add(person)
            await session.flush()
            session.add(row)
            return await enrol(session, clock, "r1"), cookie
    finally:
        await database.close()


@pytest.fixture
async def admitted(settings: Settings) -> tuple[str, str]:
    return await _admitted(settings)


@pytest.fixture(params=["http", "https"])
def door(
    request: pytest.FixtureRequest, settings: Settings, admitted: tuple[str, str], tmp_path: Path
) -> Iterator[Door]:
    public, _ = certificate(tmp_path)
    trust = ssl.create_default_context(cafile=public) if request.param == "https" else None
    options = ["--tls-cert", str(public), "--tls-key", str(tmp_path / "server.key")] if trust else []
    door = Door(free_port(), trust, *admitted)
    log = tmp_path / "log"
    with serving(settings.data, log, *options, port=door.port, request_within_s=WITHIN_S, pages=settings.pages):
        until_s = time.monotonic() + 60
        while True:
            try:
                verify = trust or False
                if httpx.get(f"{door.scheme}://127.0.0.1:{door.port}/healthz", verify=verify).status_code == 200:
                    break
            except httpx.TransportError:
                assert time.monotonic() < until_s, log.read_text()
                time.sleep(0.1)
        yield door
    assert said(log, "unforeseen") == []


def cut_off_after_s(talk: socket.socket, begun_s: float) -> float:
    """When the other side ends it."""
    talk.settimeout(LATE_S)
    try:
        while talk.recv(4096):
            pass
    except (ConnectionError, ssl.SSLError):
        pass
    return time.monotonic() - begun_s


def silent_before_the_handshake(door: Door) -> float:
    with door.raw() as plain:
        return cut_off_after_s(plain, time.monotonic())


def half_a_handshake(door: Door) -> float:
    with door.raw() as plain:
        plain.sendall(b"\x16\x03\x01\x02\x00\x01")  # the beginning of a ClientHello
        return cut_off_after_s(plain, time.monotonic())


def silent(door: Door) -> float:
    with door.knock() as talk:
        return cut_off_after_s(talk, time.monotonic())


def half_a_head(door: Door) -> float:
    with door.knock() as talk:
        talk.sendall(HEAD)
        return cut_off_after_s(talk, time.monotonic())


def half_a_body(door: Door) -> float:
    with door.knock() as talk:
        talk.sendall(WHOLE[:-10])
        return cut_off_after_s(talk, time.monotonic())


def half_a_second_request(door: Door) -> float:
    with door.knock() as talk:
        talk.sendall(WHOLE)
        talk.recv(4096)
        talk.sendall(HEAD)
        return cut_off_after_s(talk, time.monotonic())


def dripping(door: Door) -> float:
    begun_s = time.monotonic()
    with door.knock() as talk:
        try:
            talk.sendall(HEAD + b"X-Slow: ")
            while time.monotonic() < begun_s + LATE_S:
                talk.sendall(b"a")
                time.sleep(0.1)
        except OSError:
            pass
        return time.monotonic() - begun_s


LIARS = (
    silent_before_the_handshake,
    half_a_handshake,
    silent,
    half_a_head,
    half_a_body,
    half_a_second_request,
    dripping,
)


def slow(door: Door) -> bytes:
    """Head and body each take most of their time, in pieces."""
    at = len(WHOLE) - len(BODY)
    with door.knock() as talk:
        for part in (WHOLE[:20], WHOLE[20:at], BODY[:10], BODY[10:]):
            talk.sendall(part)
            time.sleep(WITHIN_S * 0.4)
        return talk.recv(4096)


def streams(door: Door) -> float:
    """Return the seconds that an event stream goes on: as long as the client listens."""
    url, begun_s = f"{door.scheme}://127.0.0.1:{door.port}/api/v1/live", time.monotonic()
    name = "__Host-session" if door.trust else "session"
    with httpx.stream(
        "GET", url, headers={"Cookie": f"{name}={door.cookie}"}, timeout=60, verify=door.trust or False
    ) as answer:
        assert answer.status_code == 200
        for _ in answer.iter_raw():
            if time.monotonic() > begun_s + 3 * WITHIN_S:
                break
    return time.monotonic() - begun_s


def robot_stays(door: Door) -> bool:
    """Connected, and silent but for what a library does by itself."""
    url = f"{'wss' if door.trust else 'ws'}://127.0.0.1:{door.port}/api/v1/robots/link"
    headers = {"Authorization": f"Bearer {door.robot_token}"}
    robot: ClientConnection
    with connect_websocket(url, additional_headers=headers, ssl=door.trust, proxy=None) as robot:
        robot.send(HELLO)
        assert '"welcome"' in robot.recv(10)
        time.sleep(3 * WITHIN_S)
        return robot.ping().wait(10)


@pytest.mark.nightly
def test_who_says_half_is_cut_off_and_who_is_slow_or_stays_is_not(door: Door) -> None:
    liars_here = LIARS if door.trust else [liar for liar in LIARS if liar is not half_a_handshake]
    with ThreadPoolExecutor(len(LIARS) + 3) as threads:
        liars = {liar.__name__: threads.submit(liar, door) for liar in liars_here}
        honest, stream, robot = (threads.submit(one, door) for one in (slow, streams, robot_stays))
        after_s = {name: waiting.result() for name, waiting in liars.items()}
        assert honest.result().startswith(b"HTTP/1.1 401"), "it is answered: that code was not asked for"
        assert stream.result() > 3 * WITHIN_S
        assert robot.result()
    assert {name: s for name, s in after_s.items() if not WITHIN_S * 0.5 < s < LATE_S} == {}
