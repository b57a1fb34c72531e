"""Fixtures that all tests share: hypothesis without a stop-watch, and the browser, or a word that there is none."""

import gc
import os
from collections.abc import Generator, Iterator
from typing import Any

import pytest
import structlog
from hypothesis import settings

from benchmarks.pages.chromium import find_chromium

# A shared machine is slow at times; slowness is for the benchmarks to judge.
settings.register_profile("campus_mail", deadline=None, print_blob=True)
settings.load_profile("campus_mail")

NOT_RUN = pytest.StashKey[int]()
PLAIN = [
    *structlog.get_config()["processors"][:-1],
    structlog.dev.ConsoleRenderer(exception_formatter=structlog.dev.plain_traceback),
]


@pytest.fixture(autouse=True)
def logs_of_its_own() -> Iterator[None]:
    """A command that a test runs within its own process configures the logs of that process.

    Tracebacks are plain: with all local variables, as structlog prints them by default, one takes a minute of the
    whole service.
    """
    structlog.configure(processors=PLAIN)
    yield
    structlog.reset_defaults()


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Import all tests without looking for garbage, and exempt what was imported: that took a fifth of their time."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def chromium() -> str | None:
    try:
        return find_chromium()
    except FileNotFoundError as error:
        raise pytest.UsageError(str(error)) from error


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Without a browser its tests are taken out and counted; CAMPUS_MAIL_REQUIRE_BROWSER makes that a failure.

    What joins real processes takes longest and comes first, and then what needs a browser: else one of the workers
    would end long after the others.
    """
    items.sort(key=lambda item: (item.get_closest_marker("system") is None, item.get_closest_marker("browser") is None))
    browser_tests = [item for item in items if item.get_closest_marker("browser")]
    if not browser_tests or chromium():
        return
    if os.environ.get("CAMPUS_MAIL_REQUIRE_BROWSER"):
        raise pytest.UsageError(f"no Chromium found, and {len(browser_tests)} browser tests must run")
    items[:] = [item for item in items if item not in browser_tests]
    config.hook.pytest_deselected(items=browser_tests)
    config.stash[NOT_RUN] = len(browser_tests)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:
    """Beside each other, only the workers know what they left out; each of them has left out the same."""
    node.config.stash[NOT_RUN] = getattr(node, "workeroutput", {}).get("not_run", 0)


def pytest_sessionfinish(session: pytest.Session) -> None:
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["not_run"] = session.config.stash.get(NOT_RUN, 0)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """The last line of all: what did not run must not scroll away."""
    if hasattr(config, "workeroutput"):
        return
    count = config.stash.get(NOT_RUN, 0)
    if count:
        way_out = "no Chromium found: apt install chromium, or set CHROMIUM=/path"
        config.get_terminal_writer().line(f"NOT RUN: {count} browser test{'s'[: count > 1]} ({way_out})", yellow=True)


@pytest.fixture(scope="session")
def browser_type_launch_args(browser_type_launch_args: dict[str, Any]) -> dict[str, Any]:
    """Playwright drives the system's Chromium. Root (a container) has no sandbox to give."""
    no_sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []
    return {**browser_type_launch_args, "executable_path": chromium(), "args": no_sandbox}
