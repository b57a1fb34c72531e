"""Cookies travel with any request a browser sends, so what changes something must come from our own pages."""

from urllib.parse import urlsplit

from starlette.requests import HTTPConnection, Request

from app.accounts.errors import CrossSite, HttpsRequired

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
LOOPBACK = frozenset({"localhost", "127.0.0.1", "::1"})


def require_same_origin(request: Request) -> None:
    """For requests that carry the cookie: unsafe ones need `Sec-Fetch-Site: same-origin` or our own `Origin`."""
    if request.method in SAFE_METHODS or _comes_from_here(request):
        return
    raise CrossSite("This request did not come from Campus Mail's own pages (Sec-Fetch-Site or Origin says which).")


def refuse_other_sites(request: Request) -> None:
    """For requests without a cookie: a browser that says it comes from elsewhere is refused, a script is not."""
    says_something = "sec-fetch-site" in request.headers or "origin" in request.headers
    if says_something and not _comes_from_here(request):
        raise CrossSite("This request came from another site.")


def travels_safely(connection: HTTPConnection) -> bool:
    """Encrypted, or within this machine."""
    return connection.url.scheme in {"https", "wss"} or connection.url.hostname in LOOPBACK


def require_https_or_loopback(request: Request) -> None:
    """A session must not travel in the open."""
    if not travels_safely(request):
        raise HttpsRequired("Campus Mail is used over https; plain http is taken on this machine alone.")


def _comes_from_here(request: Request) -> bool:
    if "sec-fetch-site" in request.headers:
        return request.headers["sec-fetch-site"] == "same-origin"
    try:
        origin = urlsplit(request.headers.get("origin", ""))
    except ValueError:  # no URL at all
        return False
    return (origin.scheme, origin.netloc) == (request.url.scheme, request.url.netloc)
