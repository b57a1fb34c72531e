"""A Chromium and a service for all tests of the pages, and people who visit it.

Playwright's asynchronous interface, on one event loop for all of them: its synchronous one leaves a loop running in
the thread, in which the asynchronous tests of other folders could not run.
"""

from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack
from itertools import count
from pathlib import Path
from typing import Any

import pytest
import pytest_asyncio
from playwright.async_api import Browser, Playwright, async_playwright, expect

from benchmarks.pages.chromium import find_chromium
from tests.app.robots.playing import PlayedRobot
from tests.web.mailroom_scene import Campus
from tests.web.service import Service
from tests.web.visitor import Visit, Visitor

QUIET = ["--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync"]
QUIET += ["--no-first-run"]
# Nothing is as slow as this; a machine that has other things to do may be.
expect.set_options(timeout=15_000)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests that are functions of the browser share its loop."""
    for item in items:
        if item.path.parent == Path(__file__).parent and item.get_closest_marker("browser"):
            item.add_marker(pytest.mark.asyncio(loop_scope="session"), append=False)


@pytest.fixture(scope="session")
def browser_type_launch_args(browser_type_launch_args: dict[str, Any]) -> dict[str, Any]:
    return {**browser_type_launch_args, "args": [*browser_type_launch_args["args"], *QUIET]}


@pytest_asyncio.fixture(scope="session", loop_scope="session")
async def playwright_here() -> AsyncIterator[Playwright]:
    async with async_playwright() as playwright:
        yield playwright


@pytest_asyncio.fixture(scope="session", loop_scope="session")
async def chromium(playwright_here: Playwright, browser_type_launch_args: dict[str, Any]) -> AsyncIterator[Browser]:
    browser = await playwright_here.chromium.launch(**browser_type_launch_args)
    yield browser
    await browser.close()


@pytest_asyncio.fixture(scope="session", loop_scope="session")
async def whole_chromium(
    playwright_here: Playwright, browser_type_launch_args: dict[str, Any]
) -> AsyncIterator[Browser]:
    """With all that belongs to windows and the system: notices, installed apps, what is sent later."""
    arguments = {**browser_type_launch_args, "executable_path": find_chromium(whole=True)}
    browser = await playwright_here.chromium.launch(**arguments)
    yield browser
    await browser.close()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """One without robots: what is ordered there stays in the queue."""
    with Service(tmp_path_factory.mktemp("service")) as service:
        yield service


def device(playwright: Playwright, name: str) -> dict[str, Any]:
    """Options of a browser context that is a `phone` or a `desk`."""
    if name == "desk":
        return {"viewport": {"width": 1280, "height": 860}}
    return {key: value for key, value in playwright.devices["Pixel 7"].items() if key != "default_browser_type"}


_newcomers = count(1)


@pytest_asyncio.fixture(loop_scope="session")
async def visit(chromium: Browser, playwright_here: Playwright, service: Service) -> AsyncIterator[Visit]:
    """`await visit("ada.king", on="phone")`: a new visitor, signed in unless `signed_in=False`."""
    async with AsyncExitStack() as visitors:

        async def come(
            name: str = "ada", on: str = "desk", at: Service = service, signed_in: bool = True, **options: Any
        ) -> Visitor:
            # A worker answers for the network that many tests cut: only tests of the worker let it in.
            context = {"locale": "en-CA", "service_workers": "block", **device(playwright_here, on), **options}
            email = f"{name}.n{next(_newcomers)}@campus.example"
            visitor = await visitors.enter_async_context(Visitor(chromium, at, email, context))
            return await visitor.sign_in() if signed_in else visitor

        yield come


@pytest.fixture(scope="module")
def quiet_campus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Campus]:
    """A module's own, in which nothing has happened yet."""
    with Service(tmp_path_factory.mktemp("quiet")) as service:
        yield Campus(service)


@pytest_asyncio.fixture(loop_scope="session")
async def robot(quiet_campus: Campus, request: pytest.FixtureRequest) -> AsyncIterator[PlayedRobot]:
    """Each test on the quiet campus has one of its own, the only one that is connected."""
    async with quiet_campus.service.connected(f"r{len(request.node.name)}") as robot:
        yield robot
