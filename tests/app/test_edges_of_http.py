"""Malformed requests that strangers may send, and the form of pages and streams on the wire."""

import base64
import gzip
import json
from collections.abc import Iterator
from pathlib import Path

import brotli
import httpx
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from app.http.body_limit import MAX_BODY_BYTES
from tests.app.conftest import RECIPIENT, Browser, Served

CODES = "/api/v1/sign-in/codes"
AS_JSON = {"Content-Type": "application/json"}


def said(answer: httpx.Response) -> tuple[int, str]:
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.status_code, answer.json()["code"]


def headers_of(browser: Browser) -> dict[str, str]:
    return {"Cookie": f"session={browser.cookies['session']}", "Sec-Fetch-Site": "same-origin"}


def test_a_body_that_says_it_is_huge_is_refused_unread(served: Served) -> None:
    answer = httpx.post(served.url + CODES, content=b"x" * (MAX_BODY_BYTES + 1))
    assert said(answer) == (413, "too_large")


def test_a_body_that_never_ends_is_refused_on_the_way(served: Served) -> None:
    def pieces() -> Iterator[bytes]:
        yield b'{"email": "'
        for _ in range(100):
            yield b"a" * 1024

    answer = httpx.post(served.url + CODES, content=pieces(), headers={"Content-Type": "application/json"})
    assert said(answer) == (413, "too_large")


def test_the_largest_body_that_is_taken_is_read(served: Served) -> None:
    answer = httpx.post(served.url + CODES, content=b" " * (MAX_BODY_BYTES - 2) + b"{}", headers=AS_JSON)
    assert said(answer) == (422, "invalid_request")


@pytest.mark.parametrize("body", [b"[" * 20_000, b'{"from_post": "\xff"}', b"[1" + b"0" * 5000 + b"]"])
def test_a_body_that_cannot_be_read_is_a_bad_request(served: Served, sender: Browser, body: bytes) -> None:
    headers = {**headers_of(sender), "Idempotency-Key": "k", "Content-Type": "application/json"}
    assert said(httpx.post(f"{served.url}/api/v1/orders", content=body, headers=headers)) == (400, "malformed_body")


@pytest.mark.parametrize("kind", [{"Content-Type": "text/plain"}, {"Content-Type": "application/jsonish"}, {}])
def test_a_body_of_another_type_is_no_order(served: Served, sender: Browser, kind: dict[str, str]) -> None:
    headers = {**headers_of(sender), "Idempotency-Key": "k", **kind}
    body = f'{{"from_post": "post1", "to_post": "post4", "recipient": "{RECIPIENT}"}}'
    answer = httpx.post(f"{served.url}/api/v1/orders", content=body, headers=headers)
    assert said(answer) == (415, "unsupported_media_type")
    assert httpx.get(f"{served.url}/api/v1/orders", headers=headers_of(sender)).json()["items"] == []


@pytest.mark.parametrize("place", ["0001-01-01T00:00:00+23:59 o", "2026-01-01T00:00:00 o", "2026-01-01T00:00:00+00:00"])
def test_a_cursor_that_points_nowhere_is_refused(sender: Browser, place: str) -> None:
    cursor = base64.urlsafe_b64encode(place.encode()).decode()
    answer = sender.get("/api/v1/orders", params={"cursor": cursor})
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_cursor")


async def test_a_socket_that_is_not_there_is_answered_by_a_problem(served: Served) -> None:
    with pytest.raises(InvalidStatus) as refused:
        async with connect(served.url.replace("http", "ws") + "/api/v1/nowhere"):
            pass
    answer = refused.value.response
    assert (answer.status_code, answer.headers["content-type"]) == (404, "application/problem+json")
    assert json.loads(answer.body or b"")["code"] == "not_found"


@pytest.mark.parametrize("origin", ["http://[::", "null", "http://127.0.0.1.evil.example"])
def test_an_origin_that_is_not_ours_or_none_at_all_is_another_site(served: Served, origin: str) -> None:
    answer = httpx.post(served.url + CODES, json={"email": "ann@campus.example"}, headers={"Origin": origin})
    assert said(answer) == (403, "cross_site")


@pytest.mark.parametrize(
    "path",
    [
        "/package.json",
        "/.%2fpackage.json",
        "/x/..%2fnode_modules/lit/package.json",
        "/%6eode_modules/lit/x.js",
        "/src/..%2fpackage.json",
    ],
)
def test_what_is_for_those_who_work_on_the_pages_is_hidden(served: Served, pages: Path, path: str) -> None:
    (pages / "node_modules" / "lit").mkdir(parents=True)
    for name in ("package.json", "node_modules/lit/package.json", "node_modules/lit/x.js"):
        (pages / name).write_text("{}")
    assert said(httpx.get(served.url + path)) == (404, "not_found")


@pytest.mark.slow
def test_pages_are_compressed_and_the_api_is_not(served: Served, pages: Path, sender: Browser) -> None:
    text = "<p>Campus Mail</p>" * 100
    (pages / "public/long.html").write_text(text)
    with httpx.stream("GET", f"{served.url}/long.html", headers={"Accept-Encoding": "gzip"}) as page:
        assert page.headers["content-encoding"] == "gzip"
        assert page.headers["vary"] == "Accept-Encoding"
        assert "content-security-policy" in page.headers
        assert gzip.decompress(b"".join(page.iter_raw())).decode() == text
    with httpx.stream("GET", f"{served.url}/long.html", headers={"Accept-Encoding": "gzip, deflate, br, zstd"}) as page:
        assert page.headers["content-encoding"] == "br"
        assert page.headers["vary"] == "Accept-Encoding"
        assert brotli.decompress(b"".join(page.iter_raw())).decode() == text
    (pages / "public/long.html").write_text(text + "<p>And more</p>")
    with httpx.stream("GET", f"{served.url}/long.html", headers={"Accept-Encoding": "br;q=0, gzip"}) as page:
        assert gzip.decompress(b"".join(page.iter_raw())).decode() == text + "<p>And more</p>", "as it is now"
    with httpx.stream("GET", f"{served.url}/long.html", headers={"Accept-Encoding": "br"}) as page:
        assert brotli.decompress(b"".join(page.iter_raw())).decode() == text + "<p>And more</p>", "as it is now"
    (pages / "public/long.html").write_text(text)
    plain = httpx.get(f"{served.url}/long.html", headers={"Accept-Encoding": "identity"})
    assert ("content-encoding" in plain.headers, plain.text) == (False, text)
    part = httpx.get(f"{served.url}/long.html", headers={"Accept-Encoding": "gzip", "Range": "bytes=3-8"})
    assert (part.status_code, part.text) == (206, text[3:9])
    document = httpx.get(f"{served.url}/api/v1/openapi.json", headers={"Accept-Encoding": "gzip"})
    assert len(document.content) > 1000
    assert "content-encoding" not in document.headers
    campus = httpx.get(f"{served.url}/api/v1/map", headers={"Accept-Encoding": "gzip"})
    assert campus.headers["content-encoding"] == "gzip", "but for the map, which is the same for everybody"
    assert campus.json() == httpx.get(f"{served.url}/api/v1/map", headers={"Accept-Encoding": "identity"}).json()
    with httpx.stream("GET", f"{served.url}/api/v1/live", headers=headers_of(sender)) as stream:
        assert "content-encoding" not in stream.headers
        assert next(stream.iter_lines()) == ": following", "at once, and not when some buffer is full"


def test_a_page_that_is_known_is_not_sent_again(served: Served) -> None:
    first = httpx.get(f"{served.url}/")
    again = httpx.get(f"{served.url}/", headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
