"""A full disk and a lock that another holds: requests that only read are answered, and no client waits for long."""

import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from threading import Thread

import pytest
from fastapi.testclient import TestClient

from app.accounts.sessions.sessions import SEEN_EVERY
from app.core.settings import Settings
from protocol.clock import SteppedClock
from tests.app.conftest import Browser, sqlite_alone
from tests.app.full_disk import no_room, small_disk

pytestmark = sqlite_alone
WAIT_S = 1.5
READ = ("/api/v1/orders", "/api/v1/me", "/api/v1/notices")


@pytest.fixture
def settings(settings: Settings) -> Iterator[Settings]:
    with small_disk(settings.data):
        yield settings.model_copy(update={"database_wait_s": WAIT_S})


@contextmanager
def held_lock(settings: Settings) -> Iterator[None]:
    """Another program writes in the database and does not come to an end."""
    with closing(sqlite3.connect(settings.data / "campus-mail.sqlite", isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        yield
        other.execute("ROLLBACK")


@pytest.fixture
def script(sender: Browser, anonymous: TestClient) -> dict[str, str]:
    """The headers of a script that may read."""
    made = sender.post("/api/v1/tokens", json={"name": "reader", "scopes": ["orders:read"], "days": 7})
    assert made.status_code == 201, made.text
    return {"Authorization": f"Bearer {made.json()['token']}"}


def seen_at(browser: Browser) -> str:
    [session] = browser.get("/api/v1/sessions").json()["items"]
    return str(session["seen_at"])


@pytest.mark.parametrize("fault", ["full disk", "held lock"])
@pytest.mark.slow
def test_who_reads_is_answered_at_once_and_readiness_tells(
    fault: str, settings: Settings, clock: SteppedClock, sender: Browser, script: dict[str, str], anonymous: TestClient
) -> None:
    clock.advance(SEEN_EVERY.total_seconds())  # so that it is time to note that they are here
    opened = seen_at(sender)
    clock.advance(SEEN_EVERY.total_seconds())
    with no_room(settings.data) if fault == "full disk" else held_lock(settings):
        begun_s = time.monotonic()
        answers = {path: sender.get(path).status_code for path in READ}
        answers["script"] = anonymous.get("/api/v1/orders", headers=script).status_code
        took_s = time.monotonic() - begun_s
        ready = anonymous.get("/readyz")
    assert set(answers.values()) == {200}, answers
    assert took_s < WAIT_S
    assert (ready.status_code, ready.json()["code"]) == (503, "not_ready")
    assert ("full" in ready.json()["detail"]) if fault == "full disk" else ("locked" in ready.json()["detail"])
    assert anonymous.get("/readyz").json() == {"status": "ready"}, "as soon as there is room"
    while seen_at(sender) == opened:
        time.sleep(0.01)


def test_who_writes_waits_for_one_deadline_and_not_for_each_other(settings: Settings, sender: Browser) -> None:
    ends: list[tuple[int, str | None, float]] = []

    def order() -> None:
        begun_s = time.monotonic()
        answer = sender.patch("/api/v1/me", json={"name": "Ann"})
        ends.append((answer.status_code, answer.headers.get("Retry-After"), time.monotonic() - begun_s))

    with held_lock(settings):
        asking = [Thread(target=order) for _ in range(3)]
        for one in asking:
            one.start()
        for one in asking:
            one.join()
    assert [end[:2] for end in ends] == 3 * [(503, "5")]
    assert max(took_s for _, _, took_s in ends) < 2 * WAIT_S
