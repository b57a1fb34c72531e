"""The way out to addresses that people gave us (push, webhooks): never to a machine behind the campus's own walls.

A name is resolved once, every answer is checked, and the connection goes to the address that was checked: a second
answer of the name server cannot lead elsewhere. A redirect is a new request, and is checked as such.
"""

import asyncio
import socket
import ssl
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Final

import httpx

from app.core.errors import Unprocessable
from app.core.special_networks import Network, is_public

Resolve = Callable[[str, int], Awaitable[list[str]]]
TIMEOUT_S: Final = 10.0


class TargetRefused(Unprocessable):
    """Not https, not at a port that is allowed, not resolved, or not an address of the public network."""

    code = "target_refused"


@dataclass(frozen=True)
class Target:
    """An URL that may be asked, and the `address` to connect to for it."""

    url: str
    host: str
    port: int
    address: str


async def resolve(host: str, port: int) -> list[str]:
    """Return all addresses of a name. Raises OSError."""
    found = await asyncio.get_running_loop().getaddrinfo(host, port, type=socket.SOCK_STREAM)
    return [str(address[0]) for *_, address in found]


@dataclass(frozen=True)
class HttpClient:
    """`ports` and `refused` are the operator's: where else than at 443, and public networks that are refused all the
    same. `allow_private` (any network and port, plain http) is for tests that have a server of their own."""

    ports: Sequence[int] = (443,)
    refused: Sequence[Network] = ()
    allow_private: bool = False
    resolve: Resolve = field(default=resolve)

    async def checked_target(self, url: str) -> Target:
        """Where to connect to for this URL. Raises TargetRefused."""
        asked = _parsed(url)
        if asked.scheme != "https" and not (self.allow_private and asked.scheme == "http"):
            raise TargetRefused("The address must begin with https://.")
        # As it travels: in letters of another script a name may be read as two different ones.
        host = asked.raw_host.decode("ascii")
        if not host or asked.userinfo:
            raise TargetRefused("The address must name a host, without a user name or password.")
        port = {"https": 443, "http": 80}[asked.scheme] if asked.port is None else asked.port
        if not self.allow_private and port not in self.ports:
            raise TargetRefused(f"Port {port} is not among those that may be asked: {_listed(self.ports)}.")
        addresses = await self._addresses(host, port)
        # All of them: a name that has one address inside has no business here, whichever would be taken.
        if not self.allow_private and not all(is_public(one, self.refused) for one in addresses):
            raise TargetRefused(f"{host} is not on the public network.")
        # A certificate is for the name, without the dot that ends it in the name server's own files.
        return Target(url, host.removesuffix("."), port, addresses[0])

    async def _addresses(self, host: str, port: int) -> list[str]:
        try:
            async with asyncio.timeout(TIMEOUT_S):
                found = await self.resolve(host, port)
        except (OSError, UnicodeError):  # TimeoutError is an OSError
            found = []
        if not found:
            raise TargetRefused(f"The name {host} leads nowhere.")
        return found

    def client(self) -> httpx.AsyncClient:
        """An HTTP client that can reach nothing else. It raises TargetRefused for whatever it refuses."""
        return httpx.AsyncClient(transport=_Guarded(self), timeout=TIMEOUT_S, trust_env=False)


@cache
def trusted() -> ssl.SSLContext:
    """By whom a server's certificate may be signed: hundreds of authorities, which take 25 ms to read."""
    return httpx.create_ssl_context(trust_env=False)


@cache
def trusted_here() -> ssl.SSLContext:
    """The same, and whom this machine trusts besides (its store, SSL_CERT_FILE): for addresses that the operator has
    set. A campus may sign the certificates of its own servers."""
    context = httpx.create_ssl_context(trust_env=False)
    context.load_default_certs()
    return context


def _listed(ports: Sequence[int]) -> str:
    return ", ".join(map(str, ports))


def _parsed(url: str) -> httpx.URL:
    try:
        return httpx.URL(url)
    except httpx.InvalidURL as error:
        raise TargetRefused(f"This is no address: {error}.") from None


class _Guarded(httpx.AsyncBaseTransport):
    """Checks each request, and connects to the address that was checked; TLS is for the name, as always."""

    def __init__(self, http_client: HttpClient) -> None:
        self._outside = http_client
        # No connection is used twice: it would be known by its address alone, whichever name it was made for.
        limits = httpx.Limits(max_keepalive_connections=0)
        self._wire = httpx.AsyncHTTPTransport(verify=trusted(), trust_env=False, limits=limits)

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        target = await self._outside.checked_target(str(request.url))
        pinned = httpx.Request(
            request.method,
            request.url.copy_with(host=target.address),
            headers=request.headers,
            stream=request.stream,
            extensions={**request.extensions, "sni_hostname": target.host},
        )
        return await self._wire.handle_async_request(pinned)

    async def aclose(self) -> None:
        await self._wire.aclose()
