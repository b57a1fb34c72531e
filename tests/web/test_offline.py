"""Without a network: pages open, orders are kept and sent once, codes are at hand, and nothing is left for others."""

import asyncio
import json
import os
import re
import shutil
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from playwright.async_api import Browser, CDPSession, Page, Route, expect

from app.http.page_files import PageFiles
from protocol.parts import StopAction
from protocol.to_server import Step
from tests.app.robots.playing import until
from tests.web.drawn import expect_drawn
from tests.web.service import ROOT, Service
from tests.web.test_order import fill, send
from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser


@pytest.fixture
def chromium(whole_chromium: Browser) -> Browser:
    """The shell sends nothing once its pages are closed."""
    return whole_chromium


WORKER_IS_THERE = "() => navigator.serviceWorker.controller !== null"
KEPT_ANSWERS = """async () => {
  const stores = (await caches.keys()).filter((name) => !name.startsWith("pages "));
  const kept = await Promise.all(stores.map(async (name) => (await caches.open(name)).keys()));
  return kept.flat().map(({ url }) => url.replace(/.*v1/, "")).sort();
}"""
KEPT = "Saved on this device"
LOCKS = """window.locks = [];
const request = WakeLock.prototype.request;
WakeLock.prototype.request = async function (kind) {
  const lock = await request.call(this, kind);
  window.locks.push(lock);
  return lock;
};"""
HIDE = """(hidden) => {
  Object.defineProperty(document, "hidden", { value: hidden, configurable: true });
  document.dispatchEvent(new Event("visibilitychange"));
}"""
ASKED_TO_SYNC = "async () => (await navigator.serviceWorker.ready).sync.getTags()"


@asynccontextmanager
async def no_network(person: Visitor) -> AsyncIterator[None]:
    """As in a tunnel: for pages and workers alike."""
    person.loses_answers = True
    await person.context.set_offline(True)
    yield
    await person.context.set_offline(False)


async def come_with_worker(visit, name: str = "ada", **options: Any) -> Visitor:
    """A visitor whose browser has the worker already."""
    person = await visit(name, on="phone", service_workers="allow", **options)
    await person.page.goto("/")
    await expect(person.page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await person.page.wait_for_function(WORKER_IS_THERE)
    return person


async def worker_of(person: Visitor) -> Callable[..., Awaitable[Any]]:
    """Fires events in this person's worker as the browser does, from a page that is none of ours."""
    browser: CDPSession = await person.context.new_cdp_session(await person.context.new_page())
    found: asyncio.Future[str] = asyncio.get_running_loop().create_future()

    def hear(event: dict[str, list[dict[str, str]]]) -> None:
        if event["registrations"] and not found.done():
            found.set_result(event["registrations"][-1]["registrationId"])

    browser.on("ServiceWorker.workerRegistrationUpdated", hear)
    await browser.send("ServiceWorker.enable")
    async with asyncio.timeout(15):
        to = {"origin": person.service.url, "registrationId": await found}
    return lambda event, **facts: browser.send(f"ServiceWorker.{event}", {**to, **facts})


async def is_kept(page: Page, address: str) -> None:
    there = f"(await ({KEPT_ANSWERS})()).includes(address)"
    await page.evaluate(
        f"async (address) => {{ while (!{there}) await new Promise((resolve) => setTimeout(resolve, 50)); }}", address
    )


async def sign_out(page: Page) -> None:
    await page.locator(".account summary").click()
    await page.get_by_role("button", name="Sign out").click()
    await expect(page.get_by_label("Email address")).to_be_visible()


@pytest.mark.slow
async def test_in_a_tunnel_pages_open_an_order_is_kept_and_it_is_sent_once_when_there_is_a_network(visit):
    ada = await come_with_worker(visit, "ada.king")
    page = ada.page
    await page.reload()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    async with no_network(ada):
        await page.reload()
        await expect(page.get_by_text(re.compile("^No connection"))).to_be_visible()
        await fill(page, what="Keys")
        await send(page)
        kept = page.get_by_role("region", name=KEPT)
        await expect(kept.get_by_text("Will be sent once")).to_be_visible()
        await expect(kept).to_be_focused()
        await expect(page.get_by_label("Contents")).to_have_value("")
        await page.get_by_role("link", name="My mail").click()
        await expect(page.get_by_role("heading", name="My mail")).to_be_visible()
        await expect(kept.get_by_text("Post 1")).to_be_visible()
        await ada.assert_accessible()
        await page.goto("/")
        await expect(kept.get_by_text("Post 1")).to_be_visible()
    await kept.get_by_role("link", name="Track").click()
    await expect(page.get_by_role("heading", name="Looking for a robot")).to_be_visible()
    assert [order["description"] for order in (await ada.api("/orders"))["items"]] == ["Keys"]


@pytest.mark.slow
async def test_a_kept_order_is_sent_once_by_the_worker_though_no_page_is_open_any_more(visit):
    ada = await come_with_worker(visit, "ada.king", permissions=["background-sync"])
    page, fire = ada.page, await worker_of(ada)
    async with no_network(ada):
        await fill(page, what="Keys")
        await send(page)
        kept = page.get_by_role("region", name=KEPT)
        await expect(kept.get_by_text("Will be sent once")).to_be_visible()
        assert await page.evaluate(ASKED_TO_SYNC) == ["orders"], "the browser is to wake the worker"
        await page.close()
    # Once for the network, once more since browsers do so when the first attempt seemed to fail.
    for is_last in (False, True):
        await fire("dispatchSyncEvent", tag="orders", lastChance=is_last)

    async def ordered() -> list[str]:
        return [order["description"] for order in (await ada.api("/orders"))["items"]]

    await until(ordered, limit_s=15)
    page = await ada.new_page()
    await page.goto("/")
    await expect(page.get_by_role("region", name=KEPT).get_by_text("Sent.")).to_be_visible()
    assert await ordered() == ["Keys"]


@pytest.mark.nightly
async def test_an_order_whose_answers_are_lost_while_all_else_goes_well_is_sent_again_by_itself_and_is_one(visit):
    ada = await visit("ada.king", on="phone")
    page, lost = ada.page, []
    ada.loses_answers = True

    async def lose_some(route: Route) -> None:
        if route.request.method == "POST" and len(lost) < 4:  # three tries of the form, one of the outbox
            lost.append(await route.fetch())
            await route.abort()
        else:
            await route.continue_()

    await page.route(re.compile("/api/v1/orders$"), lose_some)
    await page.goto("/")
    await fill(page, what="Keys")
    await send(page)
    await expect(page.get_by_role("region", name=KEPT).get_by_text("Sent.")).to_be_visible()
    assert [answer.status for answer in lost] == [201] * 4
    assert [order["description"] for order in (await ada.api("/orders"))["items"]] == ["Keys"]


@pytest.mark.slow
async def test_what_is_refused_later_is_said_and_can_be_mended_or_thrown_away(visit):
    ada = await come_with_worker(visit)
    page = ada.page
    ada.refusals_expected.add("/api/v1/orders")
    kept = page.get_by_role("region", name=KEPT)
    async with no_network(ada):
        for recipient in ("eve@elsewhere.example", "mallory@elsewhere.example"):
            await fill(page, recipient=recipient)
            await send(page)
            await expect(kept.get_by_text(f"For {recipient}")).to_be_visible()
    refused = kept.get_by_role("listitem").filter(has_text=re.compile("This address is unknown"))
    await expect(refused).to_have_count(2)
    await refused.first.get_by_role("button", name="Discard").click()
    await expect(refused).to_have_count(1)
    await refused.get_by_role("button", name="Fix and send").click()
    await expect(page.get_by_label("Recipient’s email")).to_have_value("mallory@elsewhere.example")
    await expect(kept).to_be_hidden()
    assert (await ada.api("/orders"))["items"] == []


@pytest.mark.slow
async def test_what_is_kept_is_gone_at_sign_out_and_no_order_is_sent_for_another_person(visit, service: Service):
    ada = await come_with_worker(visit, "ada.king")
    page = ada.page
    await ada.order("bob.martin@campus.example", what="First")
    await page.reload()
    await expect(page.get_by_role("link", name=re.compile("To Bob Martin"))).to_be_visible()
    kept = await page.evaluate(KEPT_ANSWERS)
    assert {"/me", "/about", "/map"} <= set(kept)
    assert not [address for address in kept if re.match("/(notices|estimate|robots|live|tokens|sessions)", address)]
    async with no_network(ada):
        await fill(page, what="Ada’s own")
        await send(page)
        await expect(page.get_by_role("region", name=KEPT)).to_be_visible()
        # The next user of this browser comes by another way than the sign-out.
        await ada.context.clear_cookies()
    eve = Visitor(ada.browser, service, f"eve.{ada.email}", ada.options)
    eve.context = ada.context
    await eve.sign_in()
    await page.reload()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await expect(page.get_by_role("region", name=KEPT)).to_be_hidden()
    await expect(page.get_by_role("link", name=re.compile("To Bob Martin"))).to_be_hidden()
    assert (await eve.api("/orders"))["items"] == []
    await sign_out(page)
    assert await page.evaluate(KEPT_ANSWERS) == ["/about", "/map"]
    await ada.sign_in()
    await page.reload()
    await expect(page.get_by_role("region", name=KEPT).get_by_text("Sent.")).to_be_visible()
    assert [order["description"] for order in (await ada.api("/orders"))["items"]] == ["Ada’s own", "First"]


@pytest.mark.slow
async def test_the_files_of_the_pages_have_a_version_that_changes_with_any_of_them(tmp_path):
    made = {"public/index.html": "<p>", "src/a.js": "1", "src/notes.md": "", "types/b.js": "", "npm_modules.json": "[]"}
    for name, text in made.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    files = PageFiles(tmp_path)
    before = files.module()
    assert json.loads(before.split(b"FILES = ")[1].rstrip(b";\n"))[:3] == [
        "/",
        "/src/a.js",
        "/src/styles/everywhere.css",
    ]
    assert files.module() == before
    (tmp_path / "src/a.js").write_text("2")
    assert files.module() != before


@pytest.fixture(scope="module")
def own_pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the pages that a test may change."""
    folder = tmp_path_factory.mktemp("pages") / "web"
    shutil.copytree(
        Path(os.environ.get("CAMPUS_MAIL_PAGES") or ROOT / "web"), folder, ignore=shutil.ignore_patterns("node_modules")
    )
    (folder / "node_modules").symlink_to(ROOT / "web/node_modules")
    return folder


@pytest.fixture(scope="module")
def own_service(tmp_path_factory: pytest.TempPathFactory, own_pages: Path) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("own"), more={"CAMPUS_MAIL_PAGES": str(own_pages)}) as service:
        yield service


async def the_screen_stays_on_while_it_is_seen(page: Page) -> None:
    """Windows of tests are never hidden: the page is told that it is."""
    held = "(wanted) => window.locks.filter((lock) => !lock.released).length === wanted"
    await page.wait_for_function(held, arg=1)
    for hidden in (True, False):
        await page.evaluate(HIDE, hidden)
        await page.wait_for_function(held, arg=int(not hidden))
    assert await page.evaluate("window.locks.length") == 2
    await page.get_by_text("Show the code").click()
    await page.wait_for_function(held, arg=0)


@pytest.mark.nightly
async def test_a_code_is_at_hand_in_the_tunnel_though_its_page_was_never_opened_and_gone_with_the_order(
    visit, own_service: Service
):
    ada = await come_with_worker(visit, "ada.king", at=own_service)
    page = ada.page
    async with own_service.connected("r1") as robot:
        order_id = await ada.order("bob.martin@campus.example")
        mission = await robot.mission()
        (load,) = [stop for stop in mission.stops if stop.action is StopAction.LOAD]
        await page.add_init_script(LOCKS)
        await page.reload()
        await is_kept(page, f"/orders/{order_id}/code.svg")
        async with no_network(ada):
            await page.goto(f"/follow.html?order={order_id}")
            await page.get_by_text("Show the code").click()
            image = page.get_by_role("img", name="QR code for the robot’s camera")
            await expect(image).to_be_visible()
            await expect_drawn(image)
            await the_screen_stays_on_while_it_is_seen(page)
        await robot.report(mission, Step.ACCEPTED)
        await robot.ends(await robot.report(mission, Step.ARRIVED, load))
        await robot.ends(await robot.say(robot.receipt(load)))
        await page.goto(f"/follow.html?order={order_id}")
        await expect(page.get_by_role("heading", name="Your letter is on its way to Post 4")).to_be_visible()
        await is_kept(page, f"/orders/{order_id}")
        assert not [address for address in await page.evaluate(KEPT_ANSWERS) if "code" in address]


@pytest.mark.nightly
async def test_a_new_version_waits_for_a_tap_and_open_pages_go_on_with_their_own_files(
    visit, own_service: Service, own_pages: Path
):
    ada = await come_with_worker(visit, at=own_service)
    page, other = ada.page, await ada.new_page()
    await other.goto("/mail.html")
    await expect(other.get_by_role("heading", name="My mail")).to_be_visible()
    words = own_pages / "src/texts/en.json"
    words.write_text(words.read_text(encoding="utf-8").replace("Send a letter", "Send a parcel"), encoding="utf-8")
    await page.reload()
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    await expect(page.get_by_text("A new version of Campus Mail is available.")).to_be_visible()
    await ada.assert_accessible()
    await page.get_by_role("button", name="Update now").click()
    await expect(page.get_by_role("heading", name="Send a parcel")).to_be_visible()
    await expect(other.get_by_text("A new version of Campus Mail is available.")).to_be_visible()
    said = await other.evaluate("async () => (await (await fetch('/src/texts/en.json')).json())['order.title']")
    assert said == "Send a letter"
    await other.get_by_role("button", name="Update now").click()
    await other.get_by_role("link", name="Send").click()
    await expect(other.get_by_role("heading", name="Send a parcel")).to_be_visible()
