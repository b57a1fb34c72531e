"""Looks of what runs in the background."""

import asyncio
from itertools import pairwise

from app.core.polling import REST, PollingLoop


async def taken(looks: PollingLoop, took_s: float, woken_every_s: float, for_s: float) -> int:
    """Return the number of looks that are begun while something changes all the time."""
    begun = 0

    async def look() -> None:
        nonlocal begun
        async for _ in looks.until_stopped():
            begun += 1
            await asyncio.sleep(took_s)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(look())
        end_s = asyncio.get_running_loop().time() + for_s
        while asyncio.get_running_loop().time() < end_s:
            looks.wake()
            await asyncio.sleep(woken_every_s)
        looks.stop()
    return begun


async def test_who_is_woken_all_the_time_rests_longer_than_it_looks() -> None:
    took_s, for_s = 0.02, 0.6
    begun = await taken(PollingLoop(again_s=60, rest_s=0), took_s, 0.001, for_s)
    assert 2 <= begun <= for_s / (took_s * (1 + REST)) + 1


async def test_who_is_not_woken_looks_again_after_a_while() -> None:
    looks, begun = PollingLoop(again_s=0.01, rest_s=0), 0
    async with asyncio.timeout(30):
        async for _ in looks.until_stopped():
            begun += 1
            if begun == 3:
                looks.stop()
    assert begun == 3


async def test_what_changes_during_a_look_is_seen_by_another() -> None:
    looks, begun = PollingLoop(again_s=3600, rest_s=0), 0
    async with asyncio.timeout(30):
        async for _ in looks.until_stopped():
            begun += 1
            looks.wake() if begun == 1 else looks.stop()
    assert begun == 2


async def test_a_long_look_is_spread_out() -> None:
    """Of every stretch of time it takes no more than its share, and not only on the whole."""
    looks, pieces_s = PollingLoop(again_s=60, rest_s=0, rest=9), list[float]()
    now_s = asyncio.get_running_loop().time
    async with asyncio.timeout(30):
        async for _ in looks.until_stopped():
            for _piece in range(5):
                pieces_s.append(now_s())
                await asyncio.sleep(0.01)
                await looks.breathe()
            looks.stop()
    assert min(b - a for a, b in pairwise(pieces_s)) >= 0.01 * (1 + 9)


async def test_a_look_of_small_pieces_hardly_rests() -> None:
    looks = PollingLoop(again_s=60, rest_s=0, rest=1_000_000, longest_rest_s=3600)
    async with asyncio.timeout(30):
        async for _ in looks.until_stopped():
            for _piece in range(3):
                await looks.breathe()
            looks.stop()


async def test_an_end_waits_for_no_breath() -> None:
    looks = PollingLoop(again_s=3600, rest_s=0, rest=1_000_000, longest_rest_s=3600)
    async with asyncio.timeout(30):
        async for _ in looks.until_stopped():
            asyncio.get_running_loop().call_later(0.05, looks.stop)
            await asyncio.sleep(0.01)
            await looks.breathe()
            assert looks.is_stopped


async def test_an_end_waits_for_no_rest() -> None:
    looks, begun = PollingLoop(again_s=3600, rest_s=3600), 0
    async with asyncio.timeout(30):
        async for _ in looks.until_stopped():
            begun += 1
            asyncio.get_running_loop().call_soon(looks.stop)
    assert begun == 1
