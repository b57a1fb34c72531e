"""The service without a network: the application itself, its mails, and people who use it."""

import asyncio
import os
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from email import message_from_bytes, policy
from email.message import EmailMessage
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.accounts.current_user import SESSION_COOKIE
from app.cli.administration import migrate
from app.cli.serving import Server, config_of, listen
from app.composition import create_app
from app.core.settings import Settings
from app.models import MissionRow, OrderState, RobotRow
from app.orders.service import Actor
from app.orders.transitions import By
from protocol.clock import SteppedClock
from tests.app.compiled_once import compile_once
from tests.app.postgresql import TEMPLATE, PostgreSQL
from tests.plain_maps import PLAIN_TRACK

compile_once()

HERE = "http://127.0.0.1"
SENDER, RECIPIENT, STRANGER = (f"{name}@campus.example" for name in ("sender", "recipient", "stranger"))


@pytest.fixture
def clock() -> SteppedClock:
    return SteppedClock()


@pytest.fixture
def pages(tmp_path: Path) -> Path:
    folder = tmp_path / "pages"
    for part in ("public", "src"):
        (folder / part).mkdir(parents=True)
    (folder / "public/index.html").write_text('<script type="importmap">{"imports": {}}</script>')
    return folder


ON_POSTGRESQL = os.environ.get("CAMPUS_MAIL_TEST_DATABASE") == "postgresql"
"""The same tests run on either database."""
sqlite_alone = pytest.mark.skipif(ON_POSTGRESQL, reason="about SQLite's own file")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """On PostgreSQL only what touches the database is worth a second run."""
    if not ON_POSTGRESQL:
        return
    here = Path(__file__).parent
    left_out = [item for item in items if here in item.path.parents and "database_url" not in _fixtures_of(item)]
    items[:] = [item for item in items if item not in left_out]
    config.hook.pytest_deselected(items=left_out)


def _fixtures_of(item: pytest.Item) -> list[str]:
    return item.fixturenames if isinstance(item, pytest.Function) else []


@pytest.fixture(scope="session")
def postgresql(tmp_path_factory: pytest.TempPathFactory) -> Iterator[PostgreSQL]:
    """One server for all tests of this process, with a database at head to copy."""
    server = PostgreSQL()
    server.say(f"CREATE DATABASE {TEMPLATE}")
    data = tmp_path_factory.mktemp("template")
    asyncio.run(migrate(Settings(data=data, database_url=server.url(TEMPLATE))))
    yield server
    server.stop()


@pytest.fixture(scope="session")
def sqlite_at_head(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty SQLite database to copy: a fifth of a second of migrations for each test is minutes for all."""
    data = tmp_path_factory.mktemp("sqlite")
    asyncio.run(migrate(Settings(data=data)))
    return data / "campus-mail.sqlite"


@pytest.fixture
def database_url(request: pytest.FixtureRequest) -> Iterator[str]:
    """Empty for SQLite in the data folder; on PostgreSQL a database of this test alone, at head already."""
    if not ON_POSTGRESQL:
        yield ""
        return
    server: PostgreSQL = request.getfixturevalue("postgresql")
    name = server.new_database(TEMPLATE)
    yield server.url(name)
    server.drop(name)


@pytest.fixture
def settings(tmp_path: Path, pages: Path, database_url: str, sqlite_at_head: Path | None) -> Settings:
    data = tmp_path / "data"
    data.mkdir()
    if sqlite_at_head and not database_url:
        shutil.copy(sqlite_at_head, data)
    return Settings(
        data=data,
        map=str(PLAIN_TRACK),
        pages=pages,
        public_url="https://mail.campus.example",
        time_zone="",
        database_url=database_url,
    )


@pytest.fixture
def app(settings: Settings, clock: SteppedClock) -> FastAPI:
    return create_app(settings, clock)


@pytest.fixture
def anonymous(app: FastAPI) -> Iterator[TestClient]:
    """A browser that is not signed in."""
    with TestClient(app, base_url=HERE, raise_server_exceptions=False) as client:
        yield client


class Mails:
    """The mails in the spool folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def to(self, email: str) -> list[EmailMessage]:
        mails = [
            message_from_bytes(file.read_bytes(), policy=policy.default) for file in sorted(self.folder.glob("*.eml"))
        ]
        return [mail for mail in mails if mail["To"] == email]

    def newest_code(self, email: str) -> str:
        codes = [mail for mail in self.to(email) if mail["Message-ID"].startswith("<sign-in")]
        codes.sort(key=lambda mail: int(mail["Message-ID"].split(".")[1]))
        found = re.search(r"\b\d{8}\b", codes[-1].get_content())
        assert found
        return found[0]


@pytest.fixture
def mails(settings: Settings) -> Mails:
    return Mails(settings.spool_folder)


class Browser(TestClient):
    """One person's browser: requests come from our own page."""

    def __init__(self, app: FastAPI) -> None:
        super().__init__(app, base_url=HERE, headers={"Sec-Fetch-Site": "same-origin"}, raise_server_exceptions=False)
        self._keys = 0

    def order(self, key: str | None = None, **changes: Any) -> Any:
        self._keys += 1
        body = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT, **changes}
        return self.post(
            "/api/v1/orders", json=body, headers={"Idempotency-Key": key or f"key-{id(self)}-{self._keys}"}
        )


SignedIn = Callable[[str], Browser]


@pytest.fixture
def signed_in(request: pytest.FixtureRequest, app: FastAPI, anonymous: TestClient) -> SignedIn:
    """Sign a person in without mail and code, which take a fifth of the time of most tests, unless they are marked."""
    if request.node.get_closest_marker("mailed_codes"):
        by_mail: SignedIn = request.getfixturevalue("signed_in_by_mail")
        return by_mail
    portal = anonymous.portal
    assert portal is not None

    def sign_in(email: str) -> Browser:
        browser = Browser(app)
        browser.portal = portal  # one event loop for all: the service is one process
        browser.cookies.set(SESSION_COOKIE, portal.call(session_of, app, email), domain="127.0.0.1")
        return browser

    return sign_in


@pytest.fixture
def signed_in_by_mail(app: FastAPI, anonymous: TestClient, mails: Mails) -> SignedIn:
    """Sign a person in as they would do it: ask for a code, read the mail, type the code."""

    def sign_in(email: str) -> Browser:
        browser = Browser(app)
        browser.portal = anonymous.portal
        assert browser.post("/api/v1/sign-in/codes", json={"email": email}).status_code == 202
        answer = browser.post("/api/v1/sign-in", json={"email": email, "code": mails.newest_code(email)})
        assert answer.status_code == 200, answer.text
        return browser

    return sign_in


async def session_of(app: FastAPI, email: str) -> str:
    """A new session, as the exchange of a mailed code opens it."""
    state = app.state.parts
    async with state.database.transaction() as session:
        person = await state.sign_in_service.newcomer(
            session, email, state.settings.default_language, state.clock.utc()
        )
        token: str = state.sign_in_service.open_session(session, person, "", state.clock.utc())
        return token


@pytest.fixture
def sender(signed_in: SignedIn) -> Browser:
    return signed_in(SENDER)


@pytest.fixture
def recipient(signed_in: SignedIn) -> Browser:
    return signed_in(RECIPIENT)


class Mailroom:
    """Moves orders as dispatch and a robot would, in transactions of the running service."""

    def __init__(self, app: FastAPI, client: TestClient) -> None:
        self.app = app
        assert client.portal is not None
        self._portal = client.portal
        self._portal.call(self._enrol)

    async def _enrol(self) -> None:
        state = self.app.state.parts
        async with state.database.transaction() as session:
            session.add(RobotRow(name="r1", enrolled_at=state.clock.utc(), server_journal="j1", post="post5"))

    def robot_connects(self, *, online: bool = True) -> None:
        """r1 is there with something to do that no order is part of, or is gone again; and estimates know of it."""
        self._portal.call(self._connect, online)

    async def _connect(self, online: bool) -> None:
        state = self.app.state.parts
        async with state.database.transaction() as session:
            (await session.get_one(RobotRow, "r1")).online = online
            if await session.get(MissionRow, "m1") is None:
                session.add(MissionRow(id="m1", robot="r1", created_at=state.clock.utc()))
        await state.fleet.learning.poll()

    def move(self, order_id: str, *states: str, by: By = By.ROBOT, **known: Any) -> list[bool]:
        return [self._portal.call(self._move, order_id, OrderState(state), by, known) for state in states]

    async def _move(self, order_id: str, to: OrderState, by: By, known: dict[str, Any]) -> bool:
        by = By.DISPATCHER if to is OrderState.ASSIGNED else by
        async with self.app.state.parts.database.transaction() as session:
            moved: bool = await self.app.state.parts.orders.ledger.move(
                session, order_id, to, Actor(by, robot="r1", **known)
            )
            return moved

    def send_mails(self) -> None:
        """Let the service's own worker send everything that is due, and wait until it has."""
        self._portal.call(self._send_mails)

    async def _send_mails(self) -> None:
        self.app.state.parts.outbox_worker.wake()
        async with asyncio.timeout(10):
            while await self.app.state.parts.outbox_worker.has_work():  # noqa: ASYNC110  # the worker rings no bell of ours
                await asyncio.sleep(0.01)

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        return self._portal.call(function, *arguments)


@pytest.fixture
def mailroom(app: FastAPI, anonymous: TestClient) -> Mailroom:
    return Mailroom(app, anonymous)


@dataclass(frozen=True)
class Served:
    """The service listening on a port of its own."""

    url: str
    server: Server


@pytest.fixture
def served(app: FastAPI, anonymous: TestClient) -> Iterator[Served]:
    """The real server, in the loop of the test client, which runs the lifespan already."""
    config = config_of(app)
    config.lifespan = "off"
    server = Server(app, config)
    assert anonymous.portal is not None
    with listen("127.0.0.1", 0) as listening:
        serving = anonymous.portal.start_task_soon(server.serve, [listening])
        yield Served(f"http://127.0.0.1:{listening.getsockname()[1]}", server)
        server.should_exit = True
        serving.result(10)
