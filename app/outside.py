"""The way out to addresses that people gave us (push, webhooks): never to a machine behind the campus's own walls.

A name is resolved once, every answer is checked, and the connection goes to the address that was checked: a second
answer of the name server cannot lead elsewhere. A redirect is a new request, and is checked as such.
"""

import asyncio
import socket
import ssl
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from functools import cache
from ipaddress import IPv4Address, IPv6Address, IPv6Network, ip_address
from typing import Final

import httpx

from app.errors import Unprocessable

Resolve = Callable[[str, int], Awaitable[list[str]]]
NAT64: Final = IPv6Network("64:ff9b::/96")
TIMEOUT_S: Final = 10.0


class TargetRefused(Unprocessable):
    """Not https, not resolved, or not an address of the public network."""

    code = "target_refused"


@dataclass(frozen=True)
class Target:
    """An URL that may be asked, and the `address` to connect to for it."""

    url: str
    host: str
    port: int
    address: str


async def resolve(host: str, port: int) -> list[str]:
    """All addresses of a name. Raises OSError."""
    found = await asyncio.get_running_loop().getaddrinfo(host, port, type=socket.SOCK_STREAM)
    return [str(address[0]) for *_, address in found]


def is_public(address: str) -> bool:
    """Whether an address belongs to the public network, and not through a tunnel to another either."""
    ip = ip_address(address.partition("%")[0])
    if isinstance(ip, IPv6Address) and (inner := _carried(ip)):
        return inner.is_global and not inner.is_multicast
    return ip.is_global and not ip.is_multicast


def _carried(ip: IPv6Address) -> IPv4Address | None:
    """The IPv4 address that packets to this one end up at, if they do."""
    if ip in NAT64:
        return IPv4Address(int(ip) & 0xFFFFFFFF)
    return ip.ipv4_mapped or ip.sixtofour or (ip.teredo[1] if ip.teredo else None)


@dataclass(frozen=True)
class Outside:
    """`allow_private` (and with it plain http) is for tests that have a server of their own on this machine."""

    allow_private: bool = False
    resolve: Resolve = field(default=resolve)

    async def checked_target(self, url: str) -> Target:
        """Where to connect to for this URL. Raises TargetRefused."""
        asked = _parsed(url)
        if asked.scheme != "https" and not (self.allow_private and asked.scheme == "http"):
            raise TargetRefused("The address must begin with https://.")
        if not asked.host or asked.userinfo:
            raise TargetRefused("The address must name a host, and nobody who signs in there.")
        port = asked.port or {"https": 443, "http": 80}[asked.scheme]
        addresses = await self._addresses(asked.host, port)
        # All of them: a name that has one address inside has no business here, whichever would be taken.
        if not self.allow_private and not all(is_public(one) for one in addresses):
            raise TargetRefused(f"{asked.host} is not on the public network.")
        return Target(url, asked.host, port, addresses[0])

    async def _addresses(self, host: str, port: int) -> list[str]:
        try:
            found = await self.resolve(host, port)
        except (OSError, UnicodeError):
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


def _parsed(url: str) -> httpx.URL:
    try:
        return httpx.URL(url)
    except httpx.InvalidURL as error:
        raise TargetRefused(f"This is no address: {error}.") from None


class _Guarded(httpx.AsyncBaseTransport):
    """Checks each request, and connects to the address that was checked; TLS is for the name, as always."""

    def __init__(self, outside: Outside) -> None:
        self._outside = outside
        # No connection is used twice: it would be known by its address alone, whichever name it was made for.
        limits = httpx.Limits(max_keepalive_connections=0)
        self._wire = httpx.AsyncHTTPTransport(verify=trusted(), trust_env=False, limits=limits)

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        target = await self._outside.checked_target(str(request.url))
        pinned = httpx.Request(
            request.method,
            request.url.copy_with(host=target.address.partition("%")[0]),
            headers=request.headers,
            stream=request.stream,
            extensions={**request.extensions, "sni_hostname": target.host},
        )
        return await self._wire.handle_async_request(pinned)

    async def aclose(self) -> None:
        await self._wire.aclose()
