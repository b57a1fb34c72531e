"""The event stream over a real socket: who hears what, what is caught up with, and that it never holds the end up."""

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import pytest
from fastapi import FastAPI

from app.accounts.sign_in.service import find_person, set_roles
from app.core.settings import Settings
from app.models import Person, Role
from app.realtime.feed import REPLAYED, FeedEvent, LocalFeed
from tests.app.conftest import RECIPIENT, SENDER, STRANGER, Browser, Mailroom, Served, SignedIn

ANN = Person(id="ann", email="ann@campus.example", name="Ann", roles=["member"])
BOB = Person(id="bob", email="bob@campus.example", name="Bob", roles=["member"])
DAN = Person(id="dan", email="dan@campus.example", name="Dan", roles=["dispatcher", "member"])


class Stream:
    """One open event stream, read by hand."""

    def __init__(self, lines: Iterator[str]) -> None:
        self._lines = lines

    def next(self) -> tuple[str, dict[str, object], str]:
        """The next event: name, data, id. Comments are skipped."""
        event, data, id_ = "", "", ""
        for line in self._lines:
            field, _, value = line.partition(": ")
            event, data, id_ = (
                value if field == "event" else event,
                value if field == "data" else data,
                value if field == "id" else id_,
            )
            if not line and event:
                return event, json.loads(data), id_
            if not line:
                self.began_at = id_
        raise EOFError


@contextmanager
def following(url: str, browser: Browser, last_event_id: str = "", since: str = "") -> Iterator[Stream]:
    headers = {"Cookie": f"session={browser.cookies['session']}"}
    headers |= {"Last-Event-ID": last_event_id} if last_event_id else {}
    address = f"{url}/api/v1/live" + (f"?since={since}" if since else "")
    with httpx.stream("GET", address, headers=headers, timeout=10) as answer:
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith("text/event-stream")
        lines = answer.iter_lines()
        assert next(lines) == ": following"  # from here on everything is heard
        yield Stream(lines)


def order_by(browser: Browser, url: str) -> str:
    headers = {
        "Idempotency-Key": "k",
        "Sec-Fetch-Site": "same-origin",
        "Cookie": f"session={browser.cookies['session']}",
    }
    wish = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
    return str(httpx.post(f"{url}/api/v1/orders", json=wish, headers=headers).json()["id"])


def test_a_page_hears_what_concerns_its_person_and_nothing_else(
    served: Served, sender: Browser, signed_in: SignedIn
) -> None:
    stranger = signed_in(STRANGER)
    with following(served.url, sender) as stream, following(served.url, stranger) as other:
        order_id = order_by(sender, served.url)
        heard = [stream.next()[:2]]
        while {name for name, _ in heard} != {"notice", "order"}:
            heard.append(stream.next()[:2])
        assert {data.get("id") for name, data in heard if name == "order"} == {order_id}
        order_by(stranger, served.url)
        _, data, _ = other.next()
        assert order_id not in json.dumps(data), "the first thing the stranger hears is their own"


def test_a_browser_that_comes_back_is_given_what_it_missed(served: Served, sender: Browser) -> None:
    with following(served.url, sender) as stream:
        first = order_by(sender, served.url)
        heard = [stream.next() for _ in range(2)]
    cancel = {"Sec-Fetch-Site": "same-origin", "Cookie": f"session={sender.cookies['session']}"}
    httpx.post(f"{served.url}/api/v1/orders/{first}/cancel", headers=cancel)
    with following(served.url, sender, last_event_id=heard[-1][2]) as stream:
        missed = [stream.next()]
        while missed[-1][1].get("state") != "cancelled":
            missed.append(stream.next())
    assert {number for _, _, number in missed}.isdisjoint(number for _, _, number in heard)


def test_the_server_ends_within_three_seconds_with_a_stream_open(served: Served, sender: Browser) -> None:
    with following(served.url, sender) as stream:
        began_s = time.monotonic()
        served.server.should_exit = True
        with pytest.raises(EOFError):
            stream.next()
        assert time.monotonic() - began_s < 3.0


def test_a_stream_needs_a_signed_in_person(served: Served) -> None:
    answer = httpx.get(f"{served.url}/api/v1/live")
    assert (answer.status_code, answer.json()["code"]) == (401, "not_signed_in")


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"session_check_s": 0.2})


def test_a_stream_ends_with_the_session_it_was_opened_in(served: Served, sender: Browser, recipient: Browser) -> None:
    with following(served.url, sender) as stream, following(served.url, recipient) as other:
        assert sender.delete("/api/v1/session").status_code == 204
        with pytest.raises(EOFError):
            stream.next()
        order_by(recipient, served.url)
        assert other.next()[0] in {"order", "notice"}, "who is still signed in hears on"


def test_a_stream_ends_when_what_its_person_may_see_has_changed(
    app: FastAPI, served: Served, sender: Browser, mailroom: Mailroom
) -> None:
    async def make_dispatcher() -> None:
        async with app.state.parts.database.transaction() as session:
            person = await find_person(session, SENDER)
            assert person
            set_roles(person, {Role.DISPATCHER}, set())

    with following(served.url, sender) as stream:
        mailroom.call(make_dispatcher)
        with pytest.raises(EOFError):
            stream.next()


def happening(number: int, person: Person | None = None, role: Role | None = None) -> FeedEvent:
    return FeedEvent("order", {"number": number}, person.id if person else None, role)


def numbers(feed: LocalFeed, person: Person, last_id: str) -> list[object] | None:
    missed = feed.missed(person, last_id)
    return None if missed is None else [one.happening.data["number"] for one in missed]


def test_who_comes_back_is_given_what_was_missed_and_only_what_is_theirs() -> None:
    feed = LocalFeed()
    feed.publish(happening(1))
    seen = feed.last_id
    feed.publish(happening(2, ANN))
    feed.publish(happening(3, BOB))
    feed.publish(happening(4, role=Role.DISPATCHER))
    feed.publish(happening(5))
    assert numbers(feed, ANN, seen) == [2, 5]
    assert numbers(feed, BOB, seen) == [3, 5]
    assert numbers(feed, DAN, seen) == [4, 5]
    assert numbers(feed, ANN, feed.last_id) == []


def test_who_was_away_too_long_or_before_a_restart_is_told_to_fetch_anew() -> None:
    feed = LocalFeed()
    start = feed.last_id
    for number in range(REPLAYED + 1):
        feed.publish(happening(number))
    assert numbers(feed, ANN, start) is None
    assert numbers(feed, ANN, LocalFeed().last_id) is None
    assert numbers(feed, ANN, "nonsense") is None
    assert numbers(feed, ANN, start.replace("-0", "-99999999")) is None


def test_who_was_not_there_when_nothing_was_put_together_is_told_to_fetch_anew() -> None:
    feed = LocalFeed()
    assert not feed.is_heard
    feed.publish(happening(1))
    seen = feed.last_id
    feed.pass_over()
    assert numbers(feed, ANN, seen) is None, "rather than what came after it alone"
    seen = feed.last_id
    feed.publish(happening(2))
    assert numbers(feed, ANN, seen) == [2]
    with feed.listening(ANN) as heard:
        assert feed.is_heard
        feed.pass_over()  # it was not to be put together when Ann was not there yet
        only = heard.get_nowait()
        assert only is not None and only.happening.event == "resync"
        assert heard.empty()
    assert feed.is_heard, "who has just left comes back, and is given what was missed"


def test_a_listener_that_is_too_slow_is_let_go_and_the_others_hear_on() -> None:
    feed = LocalFeed()
    with feed.listening(ANN) as slow, feed.listening(BOB) as quick:
        heard = 0
        for number in range(500):
            feed.publish(happening(number))
            heard += quick.get_nowait() is not None
        assert heard == 500
        left = [slow.get_nowait() for _ in range(slow.qsize())]
    assert left[-1] is None
    assert len(left) < 500


def test_after_the_commit_and_not_before_a_change_is_told(
    app: FastAPI, sender: Browser, mailroom: Mailroom, anonymous: object
) -> None:
    feed: LocalFeed = app.state.parts.feed
    before = feed.last_id
    answer = sender.order(recipient="eve@elsewhere.example")
    assert answer.status_code == 422
    assert feed.last_id == before, "what is rolled back is never told"
    sender.order()
    assert feed.last_id != before


def test_what_changes_after_an_answer_was_read_is_told_to_clients_that_listen_since(
    served: Served, sender: Browser
) -> None:
    """A page that is being opened has what it shows before it listens, and has nothing to fetch a second time."""
    headers = {"Cookie": f"session={sender.cookies['session']}", "Sec-Fetch-Mode": "cors"}
    answer = httpx.get(f"{served.url}/api/v1/orders", headers=headers)
    order_id = order_by(sender, served.url)
    with following(served.url, sender, since=answer.headers["Feed-Position"]) as stream:
        heard = [stream.next() for _ in range(2)]
    assert order_id in {data.get("id") for name, data, _ in heard if name == "order"}
    unchanged = httpx.get(f"{served.url}/api/v1/me", headers=headers)
    again = httpx.get(f"{served.url}/api/v1/me", headers={**headers, "If-None-Match": unchanged.headers["ETag"]})
    assert again.status_code == 304
    assert again.headers["Feed-Position"] != answer.headers["Feed-Position"]
    with following(served.url, sender, since=answer.headers["Feed-Position"], last_event_id=heard[0][2]) as stream:
        assert stream.next()[2] == heard[1][2], "a browser that comes back says what it heard last"
