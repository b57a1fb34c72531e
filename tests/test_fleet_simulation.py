"""The simulated fleet on the product's own service: what it shows can be relied on, and what goes wrong is seen."""

import asyncio
import logging
from collections.abc import Coroutine, Iterator
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import pytest
import structlog

from benchmarks.fleet_simulation.durations import FITTED, Taking
from benchmarks.fleet_simulation.faults import Faults
from benchmarks.fleet_simulation.figures import figures
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.judge import ON_CROSSING_S, STUCK_S, Judge, bay, corridor, crossing
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
    fleet = Fleet(robots=2, ground=Ground("test_track"), faults=OFTEN, pace=CALM)
    first = lived(fleet, hours=0.25, seed=1)
    assert first["astray"] == []
    assert first["delivered"] > 0
    assert min(first["befallen"][kind] for kind in ("killed", "cut off", "messages lost")) > 0
    assert first["met"].keys() <= {"by a person"}
    assert lived(fleet, hours=0.25, seed=1) == first


def test_robots_that_go_in_without_permission_are_seen_to_meet() -> None:
    """Those that wait for it do not."""
    ground = Ground("test_track")
    unkept = lived(Fleet(robots=3, ground=ground, unasked=True, pace=CALM), hours=0.3, seed=2)
    kept = lived(Fleet(robots=3, ground=ground, pace=CALM), hours=0.2, seed=2)
    assert {"corridor", "crossing"} & unkept["met"].keys(), "which of them depends on how strings hash"
    assert any(f"in {place} post" in one for place in ("corridor", "crossing") for one in unkept["meetings"])
    assert kept["arrivals"] > 0
    assert (kept["met"], kept["in_the_way"]) == ({}, 0)


def test_more_robots_than_homes_are_refused() -> None:
    with pytest.raises(ValueError, match="homes for 3 robots"):
        lived(Fleet(robots=4, ground=Ground("test_track")), hours=0.1, seed=1)


class Bodies:
    """What bodies tell a judge."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.judge = Judge(TUNNELS.track, lambda: self.now_s)


def test_two_bodies_in_one_corridor_crossing_or_bay_are_seen_and_one_after_the_other_is_not() -> None:
    judge = Bodies().judge
    judge.is_in("r1", [bay("uc_bay1")])
    judge.is_in("r2", [bay("canal_bay1")])
    judge.is_in("r1", [crossing("uc"), corridor(THERE)], THERE)
    judge.is_in("r1", [corridor(THERE)], THERE)
    judge.is_in("r2", [bay("canal_bay1"), crossing("canal")])
    assert judge.met.total() == 0
    judge.is_in("r1", [corridor(THERE), crossing("canal")], THERE)
    assert (dict(judge.met), judge.meetings[0].place) == ({"crossing": 1}, "crossing canal")
    judge.is_in("r2", [bay("canal_bay1")])
    judge.is_in("r1", [crossing("canal"), bay("canal_bay1")])
    judge.is_in("r1", [crossing("canal"), corridor(BACK)], BACK)
    judge.is_in("r3", [corridor(THERE)], THERE)
    assert judge.met == {"crossing": 1, "bay": 1, "corridor": 1}
    assert judge.arrivals == 3


def test_whom_a_person_puts_in_the_way_is_that_persons_doing_until_it_has_left() -> None:
    judge = Bodies().judge
    judge.is_in("r1", [bay("uc_bay2")])
    judge.is_taken("r2")
    judge.is_put("r2", bay("uc_bay2"))
    assert judge.met == {"by a person": 1}
    judge.is_in("r2", [bay("uc_bay2"), crossing("uc")])
    judge.is_in("r2", [crossing("uc")])
    judge.is_in("r2", [crossing("uc"), bay("uc_bay2")])
    assert judge.met == {"by a person": 1, "bay": 1}


@pytest.mark.parametrize(("stood_s", "off", "in_the_way"), [(-1.0, False, 0), (1.0, False, 1), (1.0, True, 0)])
def test_who_stands_on_a_crossing_is_in_the_way_unless_it_is_off(stood_s: float, off: bool, in_the_way: int) -> None:
    bodies = Bodies()
    bodies.judge.is_in("r1", [bay("uc_bay1"), crossing("uc")])
    if off:
        bodies.judge.is_off("r1")
    bodies.now_s = ON_CROSSING_S + stood_s
    bodies.judge.is_in("r1", [crossing("uc"), corridor(THERE)], THERE)
    bodies.judge.ends()
    assert len(bodies.judge.in_the_way) == in_the_way


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


def test_ways_have_paces_of_their_own_and_the_ground_as_many_docks_as_asked(tmp_path: Path) -> None:
    campus = Ground(docks=7).read(tmp_path)
    assert [home.dock is not None for home in campus.track.home_bays] == [True] * 7 + [False]
    assert Ground().read(tmp_path).version == TUNNELS.version
    taking = Taking(TUNNELS, replace(FITTED, each_way=(1.06, 1.73), each_time=0.2), seed=1)
    there_s, back_s = ([taking.drive_s(leg, Random(n)) for n in range(50)] for leg in (THERE, BACK))
    assert max(there_s) / min(there_s) < 1.5 < (max(back_s) / min(back_s)) * 1.2
    assert sum(there_s) != pytest.approx(sum(back_s), rel=0.01)


def test_the_ground_has_no_more_bays_for_passing_than_asked_and_all_homes_and_docks(tmp_path: Path) -> None:
    one, all_of_them = Ground(bays=1).read(tmp_path).track, TUNNELS.track
    for post in TUNNELS.posts:
        here, there = ([bay for bay in track.bays_of(post) if bay.is_for_passing] for track in (one, all_of_them))
        assert len(here) == min(1, len(there))
    assert len(one.home_bays) == len(all_of_them.home_bays)
    assert len(one.docks()) == len(all_of_them.docks())


def test_what_grows_with_the_fleet_is_worked_out_beside_the_event_loop() -> None:
    seen = Run(Fleet(2, faults=OFTEN), hours=0.3, seed=4).carry_out()
    assert {"follow_and_answer", "of", "decide", "adopt", "answers", "tasks_and_journeys"} <= seen.beside_s.keys()
