"""The simulated campus: weeks of messages between robots and the service's own decisions; and what would be seen."""

from collections import Counter
from pathlib import Path
from random import Random

import pytest

from benchmarks.fleet.campus import FLEETS, draw, figures, look_at
from benchmarks.fleet.campus_core import CustodyError
from benchmarks.fleet.campus_ground import FAULTS, Faults, Ground
from benchmarks.fleet.campus_link import Link, LostMessageError
from benchmarks.fleet.campus_run import CampusRun, Fleet
from benchmarks.fleet.charging_world import Clockwork
from benchmarks.fleet.world import CollisionError
from protocol.parts import Battery, Leg, Part, Position
from protocol.to_server import Clear, Hello


@pytest.mark.parametrize("fleet", ["four_robots", "two_items_each", "long_lasting_packs"])
@pytest.mark.nightly
def test_a_whole_campus_goes_on_for_days_with_faults(fleet: str, tmp_path: Path) -> None:
    """Three days of each; hundreds of them in `make bench-fleet ARGS="campus"`."""
    lived = look_at((fleet, 4, 3.0))
    seen = figures(lived)
    assert (seen["stuck"], seen["met"], seen["lost"], seen["too_old"]) == (0, 0, 0, 0)
    assert seen["robot_hours"] == 4 * 3 * 24
    assert seen["delivered"] >= 0.9 * seen["orders"] > 10
    said = seen["messages"]
    assert said["clear"] <= said["grant"] + said.get("detour", 0) <= said["claim"]
    assert min(said[name] for name in ("hello", "welcome", "snapshot", "event", "mission", "ack")) > 0
    draw(tmp_path, {fleet: lived})
    assert "messages per robot-hour" in (tmp_path / "campus.svg").read_text()


@pytest.mark.nightly
def test_the_same_seed_is_the_same_campus() -> None:
    def lived() -> tuple[Counter[str], list[float | None]]:
        run = CampusRun(2, Fleet(3, 2, 0.5), FAULTS)
        run.run(1.5)
        return run.messages, [order.delivered_s for order in run.core.dispatch.orders.values()]

    assert lived() == lived()


@pytest.mark.parametrize(("seed", "days"), [(5, 0.8), (301, 12.2)])
@pytest.mark.nightly
def test_who_has_made_room_in_a_dock_does_not_wait_there_until_the_pack_is_empty(seed: int, days: float) -> None:
    """It did, in these: in a bay that others had to pass, or with no controller that sent it elsewhere."""
    run = CampusRun(seed, FLEETS["two_items_each"], FAULTS)
    run.run(days)
    assert [robot.stranded for robot in run.robots.values()] == [0, 0, 0, 0]


def test_robots_that_meet_and_corridors_that_were_not_granted_would_be_seen() -> None:
    ground = Ground(Clockwork(), Random(1), Faults())
    ground.enter("r0", Leg(from_post="uc", to_post="canal"))
    with pytest.raises(CollisionError, match="r1 meets r0 in canal-uc"):
        ground.enter("r1", Leg(from_post="canal", to_post="uc"))
    run = CampusRun(1, Fleet(1, 1, 0.5), Faults())
    robot = run.robots["r0"]
    robot.granted.append(Leg(from_post="uc", to_post="canal"))
    with pytest.raises(CustodyError, match="a corridor that it did not have"):
        robot.link.to_server(Clear(leg=robot.granted[0], post="canal"))
        run.clock.run(1.0)


def test_what_is_said_while_a_robot_is_away_comes_once_and_in_order() -> None:
    clock, heard = Clockwork(), list[Part]()
    link = Link("r0", clock, Counter())
    link.hello = lambda: Hello(
        position=Position(post="uc"), battery=Battery(ratio=1.0), software="simulated", map_version="1"
    )
    link.on_server.hear = heard.append
    legs = [Leg(from_post="uc", to_post=to) for to in ("canal", "azrieli", "steacie")]
    link.connect()
    link.to_server(Clear(leg=legs[0]))
    clock.run(0.1)
    link.disconnect()
    link.to_server(Clear(leg=legs[1]))
    clock.run(5.0)
    link.connect()
    link.to_server(Clear(leg=legs[2]))
    clock.run(10.0)
    assert [message.leg for message in heard if isinstance(message, Clear)] == legs
    assert link.on_robot.backlog == {}, "all of it was acknowledged"
    link.on_robot.said += 1
    with pytest.raises(LostMessageError, match="r0: clear 5 after 3"):
        link.to_server(Clear(leg=legs[0]))
        clock.run(11.0)
