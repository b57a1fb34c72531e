"""A PostgreSQL that restarts under load, and one whose lock another holds: try again soon, says every answer."""

import asyncio
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import asyncpg
import httpx
import pytest

from app.cli.administration import migrate
from app.core.settings import Settings
from tests.app.conftest import ON_POSTGRESQL, Browser
from tests.app.postgresql import PostgreSQL

pytestmark = pytest.mark.skipif(not ON_POSTGRESQL, reason="about PostgreSQL")
WAIT_S = 1.5
AWAY = (503, "database_away", "5")


@pytest.fixture
def server() -> Iterator[PostgreSQL]:
    """A server of this test's own, to be restarted."""
    server = PostgreSQL()
    yield server
    server.stop()


@pytest.fixture
def database_url(server: PostgreSQL) -> str:
    return server.url(server.new_database())


@pytest.fixture
async def settings(settings: Settings) -> Settings:
    settings = settings.model_copy(update={"database_wait_s": WAIT_S})
    await migrate(settings)
    return settings


def outcome(answer: httpx.Response) -> tuple[int, str, str]:
    code = answer.json().get("code", "") if answer.status_code >= 400 else ""
    return answer.status_code, code, answer.headers.get("Retry-After", "")


def test_a_server_that_restarts_under_load_is_answered_by_503_and_never_500(
    server: PostgreSQL, sender: Browser, recipient: Browser
) -> None:
    over = Event()

    def ask(browser: Browser, number: int) -> list[tuple[int, str, str]]:
        said = []
        while not over.is_set():
            said.append(outcome(browser.order() if number % 2 else browser.get("/api/v1/orders")))
            if number == 0:
                said.append(outcome(browser.get("/readyz")))
        return said

    with ThreadPoolExecutor(8) as threads:
        asking = [threads.submit(ask, (sender, recipient)[number % 2], number) for number in range(8)]
        for away_s in (0.0, 0.5, 0.0):
            time.sleep(0.5)
            server.restart(away_s)
        time.sleep(0.5)
        over.set()
    said = Counter(one for asked in asking for one in asked.result())
    assert AWAY in said, said
    assert set(said) <= {AWAY, (200, "", ""), (201, "", ""), (503, "not_ready", ""), (429, "", "")}, said
    assert sender.get("/api/v1/orders").status_code == 200


def test_a_lock_that_another_holds_is_waited_for_until_the_deadline(database_url: str, sender: Browser) -> None:
    """A program of the operator's, say, that stopped in the middle of a transaction."""

    async def hold(then: Callable[[], None]) -> None:
        other = await asyncpg.connect(database_url.replace("+asyncpg", ""))
        await other.execute(f"SELECT pg_advisory_lock({0x434D_0001})")
        await asyncio.to_thread(then)
        await other.close()

    def ask() -> None:
        begun_s = time.monotonic()
        said.append(outcome(sender.patch("/api/v1/me", json={"name": "Ann"})))
        said.append(outcome(sender.get("/api/v1/orders")))
        said.append(outcome(sender.get("/readyz")))
        took_s.append(time.monotonic() - begun_s)

    said: list[tuple[int, str, str]] = []
    took_s: list[float] = []
    asyncio.run(hold(ask))
    assert said == [AWAY, (200, "", ""), (503, "not_ready", "")]
    assert took_s[0] < 4 * WAIT_S
    assert sender.patch("/api/v1/me", json={"name": "Ann"}).status_code == 200
