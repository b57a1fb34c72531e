"""The simulated fleet on the product's own service: what it shows can be relied on, and what goes wrong is seen."""

import asyncio
import logging
from collections.abc import Coroutine, Iterator
from pathlib import Path
from random import Random
from typing import Any

import pytest
import structlog

from benchmarks.fleet_simulation.durations import FITTED, Taking
from benchmarks.fleet_simulation.faults import Faults
from benchmarks.fleet_simulation.figures import figures
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.judge import STUCK_S, Judge
from benchmarks.fleet_simulation.loop import LoopClock, NothingHappensError, SimulatedLoop
from benchmarks.fleet_simulation.network import Line, LineClosed
from benchmarks.fleet_simulation.service import CALM
from benchmarks.fleet_simulation.simulation import Fleet, Run
from maps import builtin_map
from protocol.parts import Leg

TUNNELS = builtin_map("carleton")
THERE, BACK = Leg(from_post="uc", to_post="canal"), Leg(from_post="canal", to_post="uc")
OFTEN = Faults(killed_h=0.1, cut_off_h=0.1, messages_lost_h=0.1, carried_h=2.0, died_h=2.0, closed_h=2.0)


@pytest.fixture(autouse=True)
def quiet() -> Iterator[None]:
    """Thousands of lines about robots that come and go would take longer than they."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
    yield
    structlog.reset_defaults()


def in_simulated_time(work: Coroutine[Any, Any, Any]) -> Any:
    with asyncio.Runner(loop_factory=SimulatedLoop) as runner:
        return runner.run(work)


def lived(fleet: Fleet, hours: float, seed: int) -> dict[str, Any]:
    seen = figures(Run(fleet, hours, seed).carry_out(), fleet.robots)
    return {name: value for name, value in seen.items() if "processor" not in name}


def test_the_same_seed_is_the_same_life_whatever_befalls_robots() -> None:
    fleet = Fleet(robots=2, ground=Ground("test_track", bays=2, docks=2), faults=OFTEN, pace=CALM)
    first = lived(fleet, hours=0.25, seed=1)
    assert first["astray"] == []
    assert first["delivered"] > 0
    assert min(first["befallen"][kind] for kind in ("killed", "cut off", "messages lost")) > 0
    assert first["met"].keys() <= {"crossing", "by a person"}, "posts have no bays on the floor yet"
    assert lived(fleet, hours=0.25, seed=1) == first


def test_robots_that_are_let_in_whoever_is_inside_are_seen_to_meet() -> None:
    """With all corridors granted at once; by the schedule they do not."""
    ground = Ground("test_track", docks=4)
    unkept = lived(Fleet(robots=4, ground=ground, traffic="at_once", pace=CALM), hours=0.2, seed=1)
    kept = lived(Fleet(robots=4, ground=ground, pace=CALM), hours=0.2, seed=1)
    assert unkept["met"]["corridor"] > 0
    assert any("in corridor post" in one for one in unkept["meetings"])
    assert kept["met"].get("corridor", 0) == 0


class Bodies:
    """What bodies tell a judge."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.judge = Judge(TUNNELS, lambda: self.now_s)


def test_two_bodies_in_one_corridor_crossing_or_dock_are_seen_and_one_after_the_other_is_not() -> None:
    bodies = Bodies()
    judge = bodies.judge
    judge.docks("r1", "uc")
    judge.docks("r2", "canal")
    judge.enters("r1", THERE)
    judge.crosses("r1", "canal")
    judge.enters("r2", BACK)
    assert judge.met.total() == 0
    judge.enters("r1", BACK)
    assert (dict(judge.met), judge.meetings[0].place) == ({"corridor": 1}, "corridor canal-uc")
    judge.crosses("r2", "uc")
    judge.crosses("r1", "uc")
    judge.docks("r1", "uc")
    judge.docks("r2", "uc")
    assert judge.met == {"corridor": 1, "crossing": 1, "dock": 1}


def test_whom_a_person_puts_in_the_way_is_that_persons_doing_until_it_has_left() -> None:
    bodies = Bodies()
    bodies.judge.crosses("r1", "uc")
    bodies.judge.is_taken("r2")
    bodies.judge.is_put("r2", "uc")
    assert bodies.judge.met == {"by a person": 1}
    bodies.judge.enters("r2", THERE)
    bodies.judge.crosses("r2", "canal")
    bodies.judge.enters("r2", BACK)
    bodies.judge.crosses("r2", "uc")
    assert bodies.judge.met == {"by a person": 1, "crossing": 1}


@pytest.mark.parametrize(("waited_s", "stuck"), [(STUCK_S - 1, 0), (STUCK_S + 1, 1)])
def test_who_waits_for_too_long_is_stuck_also_at_the_end(waited_s: float, stuck: int) -> None:
    bodies = Bodies()
    bodies.judge.waits("r1")
    bodies.now_s = waited_s
    bodies.judge.waits("r1")
    bodies.judge.ends()
    assert (bodies.judge.waits_s, len(bodies.judge.stuck)) == ([waited_s], stuck)


def test_time_leaps_and_nothing_is_waited_for_in_vain() -> None:
    async def sleeps() -> tuple[float, float]:
        clock = LoopClock(asyncio.get_running_loop())
        began = clock.utc()
        await asyncio.sleep(86400.0)
        return clock.now(), (clock.utc() - began).total_seconds()

    async def waits_for_nobody() -> None:
        await asyncio.Event().wait()

    assert in_simulated_time(sleeps()) == pytest.approx((86400.0, 86400.0))
    with pytest.raises(NothingHappensError, match="stopped without a word"):
        in_simulated_time(waits_for_nobody())


def test_what_is_said_while_a_line_is_cut_comes_late_and_in_order_and_is_lost_with_it() -> None:
    async def talks() -> list[str]:
        line, heard = Line(Random(1)), list[str]()
        await line.asgi_receive()
        for number in range(50):
            await line.send(str(number))
        line.cut()
        await asyncio.sleep(60.0)
        assert line._to_service.empty()
        line.heal()
        for _ in range(50):
            heard.append((await line.asgi_receive())["text"])
        await line.send("on its way")
        line.break_off()
        assert (await line.asgi_receive())["type"] == "websocket.disconnect"
        with pytest.raises(LineClosed):
            await line.send("too late")
        return heard

    assert in_simulated_time(talks()) == [str(number) for number in range(50)]


def test_ways_have_paces_of_their_own_and_the_ground_as_many_docks_and_bays_as_asked(tmp_path: Path) -> None:
    campus = Ground(bays=3, docks=8).read(tmp_path)
    assert (len(campus.docks()), {post.bays for post in campus.posts.values()}) == (8, {3})
    assert Ground().read(tmp_path).version == TUNNELS.version
    taking = Taking(TUNNELS, FITTED, seed=1)
    there_s, back_s = ([taking.drive_s(leg, Random(n)) for n in range(50)] for leg in (THERE, BACK))
    assert max(there_s) / min(there_s) < 1.5 < (max(back_s) / min(back_s)) * 1.2
    assert sum(there_s) != pytest.approx(sum(back_s), rel=0.01)
