"""The real service at its most talkative, used by a person, a script, a guest and a robot: its log holds no secret."""

import asyncio
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from email.message import EmailMessage
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from app.cli.administration import change_roles, enrol
from app.cli.serving import listen
from app.core.settings import ROOT, Settings
from protocol.clock import RealClock
from protocol.to_robot import Verifiers
from protocol.to_server import Step
from tests.app.conftest import SENDER, Mails, sqlite_alone
from tests.app.robots.playing import PlayedRobot

GUEST = "guest@elsewhere.example"
ORDER = {"from_post": "post1", "to_post": "post4", "recipient": GUEST}


@dataclass
class Running:
    """The service as a process, and every secret that went in or came out."""

    url: str
    settings: Settings
    log: Path
    secrets: dict[str, str] = field(default_factory=dict)

    @property
    def browser(self) -> httpx.Client:
        return httpx.Client(base_url=f"{self.url}/api/v1", headers={"Sec-Fetch-Site": "same-origin"}, timeout=20)


@pytest.fixture
def running(settings: Settings) -> Iterator[Running]:
    with listen("127.0.0.1", 0) as free:
        port = free.getsockname()[1]
    running = Running(f"http://127.0.0.1:{port}", settings, settings.data.parent / "log")
    running.secrets["client secret"] = "the-provider-knows-this-too"
    environment = {
        **os.environ,
        "CAMPUS_MAIL_DATA": str(settings.data),
        "CAMPUS_MAIL_LOG_LEVEL": "DEBUG",
        "CAMPUS_MAIL_PUBLIC_URL": "https://mail.campus.example",
        "CAMPUS_MAIL_ALLOW_OUTSIDE_RECIPIENTS": "true",
        "CAMPUS_MAIL_OIDC_ISSUER": "http://127.0.0.1:9",
        "CAMPUS_MAIL_OIDC_CLIENT_ID": "campus-mail",
        "CAMPUS_MAIL_OIDC_CLIENT_SECRET": running.secrets["client secret"],
    }
    asyncio.run(change_roles(settings, SENDER, ["maintainer", "dispatcher"], []))
    running.secrets["robot's token"] = asyncio.run(enrol(settings, "r1", again=False))
    command = [sys.executable, "-m", "app", "serve", "--port", str(port)]
    with running.log.open("wb") as log, subprocess.Popen(command, cwd=ROOT, env=environment, stderr=log) as process:
        _wait_for(running.url)
        yield running
        process.terminate()


def _wait_for(url: str) -> None:
    for _ in range(300):
        try:
            return httpx.get(f"{url}/readyz").raise_for_status() and None
        except httpx.HTTPError:
            time.sleep(0.1)
    pytest.fail("the service does not start")


@sqlite_alone
@pytest.mark.nightly
async def test_no_secret_is_in_the_log(running: Running) -> None:
    mails = Mails(running.settings.spool_folder)
    with running.browser as browser:
        _sign_in(browser, mails, running.secrets)
        _make_tokens(browser, running.secrets)
        order_id = browser.post("/orders", json=ORDER, headers={"Idempotency-Key": "k"}).json()["id"]
        await _robot_takes_the_mail(running, browser, order_id)
        _say_secrets_wrongly(browser, running.secrets, order_id)
        _follow_by_link(browser, mails, running.secrets)
        await asyncio.to_thread(_knock_where_robots_come_in, running)
        browser.delete("/session")
    running.secrets |= {file.name: file.read_text() for file in running.settings.data.glob("*.key")}
    said = running.log.read_text()
    assert '"level": "debug"' in said, "it was as talkative as it can be"
    assert "authorization: Bearer" in said, "even the headers of the robots' link are told"
    assert len(running.secrets) >= 14
    found = {name for name, secret in running.secrets.items() if _core(secret) in said}
    assert found == set()


def _core(secret: str) -> str:
    """Return a token's secret part: its prefix can be read in lists and logs. Of a key file return one line."""
    line = max(secret.split("\n"), key=len)
    return line.rpartition("_")[2] if line.startswith("cm") else line


def _sign_in(browser: httpx.Client, mails: Mails, secrets: dict[str, str]) -> None:
    browser.post("/sign-in/codes", json={"email": SENDER})
    secrets["sign-in code"] = mails.newest_code(SENDER)
    wrong = f"{(int(secrets['sign-in code']) + 1) % 10**8:08d}"
    assert browser.post("/sign-in", json={"email": SENDER, "code": wrong}).status_code == 401
    assert browser.post("/sign-in", json={"email": SENDER, "code": secrets["sign-in code"]}).status_code == 200
    secrets["cookie"] = browser.cookies["session"]


def _make_tokens(browser: httpx.Client, secrets: dict[str, str]) -> None:
    made = browser.post("/tokens", json={"name": "script", "scopes": ["orders:read"]}).json()
    secrets["script's token"] = made["token"]
    bearer = {"Authorization": f"Bearer {made['token']}"}
    assert browser.get("/orders", headers=bearer).status_code == 200
    assert browser.get("/people", headers=bearer).status_code == 403
    browser.delete(f"/tokens/{made['prefix']}")
    assert browser.get("/orders", headers=bearer).status_code == 401
    secrets["enrolment code"] = browser.post("/robots/r2/enrolment-codes").json()["code"]
    hook = browser.put("/me/webhook", json={"url": "https://hooks.invalid/secret-path-of-somebodys-hook"})
    secrets |= {"webhook": "secret-path-of-somebodys-hook"}
    secrets |= {"webhook's secret": hook.json()["secret"]} if hook.is_success else {}


def _see_code(browser: httpx.Client, order_id: str, secrets: dict[str, str]) -> None:
    code = browser.get(f"/orders/{order_id}/code").json()
    secrets |= {f"hand-over {name}": code[name] for name in ("text", "digits")}
    browser.get(f"/orders/{order_id}/code.svg")


async def _robot_takes_the_mail(running: Running, browser: httpx.Client, order_id: str) -> None:
    """It is told how to check the code, takes the mail, and says something that cannot be understood."""
    robot = PlayedRobot(RealClock())
    link = f"{running.url.replace('http', 'ws')}/api/v1/robots/link"
    async with robot.connected(link, running.secrets["robot's token"]):
        await robot.greet()
        assert isinstance((await robot.hear("verifiers")).body, Verifiers)
        mission = await robot.mission()
        load = mission.stops[0]
        await asyncio.to_thread(_see_code, browser, order_id, running.secrets)
        await robot.report(mission, Step.ACCEPTED)
        await robot.report(mission, Step.DEPARTED, load)
        await robot.report(mission, Step.ARRIVED, load)
        await robot.ends(await robot.say(robot.receipt(load)))
        await robot.say_text(json.dumps({"nonsense": running.secrets["robot's token"]}))
        await robot.close_code()


def _say_secrets_wrongly(browser: httpx.Client, secrets: dict[str, str], order_id: str) -> None:
    """Send requests as people and programs get them wrong, with the secret in the wrong place."""
    everything = " ".join(secrets.values())
    browser.post("/sign-in", content=f'{{"code": "{secrets["sign-in code"]}"')  # no JSON
    browser.post("/sign-in", json={"email": secrets["sign-in code"], "code": secrets["hand-over text"]})
    browser.post("/link/order", json={"token": everything})
    browser.post(f"/orders/{order_id}/handover", json={"digits": secrets["hand-over digits"]})
    browser.post("/robots/enrol", json={"name": "r2", "code": secrets["enrolment code"], "public_key": everything})
    browser.get("/me", headers={"Authorization": f"Bearer {secrets['cookie']}"})
    browser.get("/sign-in/oidc")
    secrets |= {"provider's code": "what-the-provider-gave-back", "state": "somebodys-state"}
    browser.get("/sign-in/oidc/callback", params={"code": secrets["provider's code"], "state": secrets["state"]})


def _follow_by_link(browser: httpx.Client, mails: Mails, secrets: dict[str, str]) -> None:
    """The mail is on its way: its recipient, who has no account, is told so with a link."""
    body = _first_mail(mails, GUEST).get_body(("plain",))
    assert body
    secrets["link"] = body.get_content().partition("one-order.html#")[2].split()[0]
    assert browser.post("/link/order", json={"token": secrets["link"]}).status_code == 200
    browser.post("/link/order", json={"token": secrets["link"][:-1]})
    browser.post("/link/order", json={"wrong_field": secrets["link"]})


def _knock_where_robots_come_in(running: Running) -> None:
    """Try every credential: uvicorn tells every header of a socket at this level."""
    link = f"{running.url.replace('http', 'ws')}/api/v1/robots/link"
    ways = [{"Cookie": f"session={running.secrets['cookie']}"}, {"Cookie": f"oidc={running.secrets['link']}"}]
    ways += [{"Authorization": f"Bearer {running.secrets[token]}"} for token in ("script's token", "link", "cookie")]
    for headers in ways:
        with connect(link, additional_headers=headers, proxy=None) as socket, pytest.raises(ConnectionClosed):
            socket.recv(timeout=5)


def _first_mail(mails: Mails, email: str) -> EmailMessage:
    for _ in range(100):
        if found := mails.to(email):
            return found[0]
        time.sleep(0.1)
    pytest.fail(f"no mail to {email}")
