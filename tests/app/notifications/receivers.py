"""Real servers for what the service sends: a mail server, and an HTTP server for pushes and webhooks."""

import asyncio
import ssl
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from email import message_from_bytes, policy
from email.message import EmailMessage
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from ipaddress import ip_address
from pathlib import Path
from typing import Any

from aiosmtpd.smtp import SMTP, AuthResult, Envelope, Session
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID

USER, PASSWORD = "campus", "a long password"


def certificate(folder: Path) -> tuple[Path, ssl.SSLContext]:
    """A certificate for 127.0.0.1 that only those trust who are given its file."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "mail server of the tests")])
    begins = datetime.now(UTC) - timedelta(days=1)
    made = (
        x509.CertificateBuilder(name, name, key.public_key(), x509.random_serial_number())
        .not_valid_before(begins)
        .not_valid_after(begins + timedelta(days=30))
        .add_extension(x509.SubjectAlternativeName([x509.IPAddress(ip_address("127.0.0.1"))]), critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(key, hashes.SHA256())
    )
    public, private = folder / "server.pem", folder / "server.key"
    public.write_bytes(made.public_bytes(serialization.Encoding.PEM))
    plain = (serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    private.write_bytes(key.private_bytes(*plain))
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(public, private)
    return public, context


@dataclass
class MailServer:
    """Speaks SMTP with AUTH and STARTTLS, or with TLS `at_once`.

    `says` has what it answers to recipients, in order; then it takes all. `cuts` has how often it hangs up: "in data",
    before it has the mail, or "after data", when it has it but has not said so.
    """

    tls: ssl.SSLContext
    at_once: bool = False
    says: list[str] = field(default_factory=list)
    cuts: list[str] = field(default_factory=list)
    hangs: bool = False
    taken: list[EmailMessage] = field(default_factory=list)
    tries: int = 0
    port: int = 0

    @asynccontextmanager
    async def listening(self) -> AsyncIterator["MailServer"]:
        loop = asyncio.get_running_loop()
        server = await loop.create_server(self._connection, "127.0.0.1", 0, ssl=self.tls if self.at_once else None)
        self.port = server.sockets[0].getsockname()[1]
        yield self
        self.hangs = False
        server.close()

    def _connection(self) -> SMTP:
        return _Connection(
            self,
            tls_context=None if self.at_once else self.tls,
            require_starttls=not self.at_once,
            auth_required=not self.at_once,
            auth_require_tls=not self.at_once,  # it does not know of an encryption that began before it
            authenticator=self._is_known,
        )

    def _is_known(self, server: Any, session: Any, envelope: Any, mechanism: str, data: Any) -> AuthResult:
        return AuthResult(success=(data.login, data.password) == (USER.encode(), PASSWORD.encode()), handled=False)

    async def handle_RCPT(  # noqa: N802  # a name of aiosmtpd's
        self, server: SMTP, session: Session, envelope: Envelope, address: str, options: list[str]
    ) -> str:
        self.tries += 1
        while self.hangs:  # noqa: ASYNC110  # a server that is slow, not one that signals
            await asyncio.sleep(0.05)
        answer = self.says.pop(0) if self.says else "250 OK"
        if answer.startswith("250"):
            envelope.rcpt_tos.append(address)
        return answer

    async def handle_DATA(self, server: SMTP, session: Session, envelope: Envelope) -> str:  # noqa: N802
        assert isinstance(envelope.content, bytes)
        self.taken.append(message_from_bytes(envelope.content, policy=policy.default))
        if self.cuts and self.cuts[0] == "after data":
            self.cuts.pop(0)
            assert server.transport
            server.transport.abort()
        return "250 taken"


class _Connection(SMTP):
    async def smtp_DATA(self, arg: str) -> None:  # noqa: N802  # a name of aiosmtpd's
        server: MailServer = self.event_handler  # type: ignore[assignment]
        if not (server.cuts and server.cuts[0] == "in data"):
            await super().smtp_DATA(arg)
            return
        server.cuts.pop(0)
        await self.push("354 go on")
        assert self.transport
        await self._reader.readline()
        self.transport.abort()


@dataclass(frozen=True)
class Received:
    """One POST."""

    path: str
    headers: dict[str, str]
    body: bytes


@dataclass
class Receiver:
    """Takes POSTs; `answers` has the status of the next ones, then it is 201. `then` is called before it answers."""

    url: str
    received: list[Received] = field(default_factory=list)
    answers: list[int] = field(default_factory=list)
    headers: dict[str, str] = field(default_factory=dict)
    then: Callable[[Received], None] = lambda one: None
    hangs: threading.Event | None = None


@contextmanager
def receiving() -> Iterator[Receiver]:
    """An HTTP server of this test, on this machine."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:  # a name of http.server's
            body = self.rfile.read(int(self.headers["Content-Length"]))
            one = Received(self.path, {name.lower(): value for name, value in self.headers.items()}, body)
            receiver.received.append(one)
            receiver.then(one)
            if receiver.hangs:
                receiver.hangs.wait(20)
            self.send_response(receiver.answers.pop(0) if receiver.answers else 201)
            for name, value in receiver.headers.items():
                self.send_header(name, value)
            self.end_headers()

        def log_message(self, *arguments: object) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        receiver = Receiver(f"http://127.0.0.1:{server.server_address[1]}")
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield receiver
        server.shutdown()
        thread.join()
