"""The worker that sends notices: it ends when it is told to, whatever it is doing then."""

import asyncio

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.notifications.delivery.worker import OutboxWorker


@pytest.mark.parametrize("steps_between", range(6))
def test_it_ends_when_it_is_cancelled_just_after_it_was_woken(
    app: FastAPI, anonymous: TestClient, steps_between: int
) -> None:
    """A service that stops right after an order must stop: there the two come within a few steps of the event loop."""
    portal = anonymous.portal
    assert portal is not None
    state = app.state.parts
    worker = OutboxWorker(state.database, state.feed, state.clock, state.outbox_worker.channels)
    assert portal.call(_wake_and_cancel, worker, steps_between)


async def _wake_and_cancel(worker: OutboxWorker, steps_between: int) -> bool:
    running = asyncio.create_task(worker.run())
    await asyncio.sleep(0.1)  # it has looked, and sleeps
    worker.wake()
    for _ in range(steps_between):
        await asyncio.sleep(0)
    running.cancel()
    ended, _ = await asyncio.wait([running], timeout=5)
    running.cancel()
    return running in ended
