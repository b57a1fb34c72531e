"""The whole robot with our agent when no recipient takes the mail, the network is away, the way is closed."""

from pathlib import Path

import pytest

from protocol.parts import Leg, Purpose, Stop, StopAction
from protocol.to_robot import Cancel, EmergencyStop, Mission, OpenWay, Pause, Recall, Resume, Revoke
from robot.simulated.obstacles import Person
from robot.simulated.start import start_pose
from tests.robot.daemon.played_service import PlayedService
from tests.robot.daemon.simulated_run import LETTER, SimulatedRun

SQUARE = Path(__file__).parents[3] / "examples" / "maps" / "square.toml"


def with_service(run: SimulatedRun) -> PlayedService:
    service = PlayedService(run.missions)
    run.missions.join(service)
    return service


def loaded_and_at_post2(run: SimulatedRun) -> None:
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    run.shows(Purpose.LOAD)
    run.until(lambda: run.is_at("post2") and run.missions.held.cargo)


@pytest.mark.nightly
def test_mail_that_nobody_took_is_given_back_to_who_loaded_it(run: SimulatedRun) -> None:
    loaded_and_at_post2(run)
    run.until(lambda: run.waits_for("wait_handover(return"), 600)
    assert run.is_at("post1")
    assert run.mind.why is not None
    assert run.mind.why.sentence == "Waiting at post1 for the mail to be taken back"
    run.shows(Purpose.LOAD)
    run.until(lambda: not run.missions.held.cargo, 10)
    run.until(lambda: run.is_home)
    told = run.told()
    assert (told.count("handover load"), told.count("handover receive"), told.count("handover return")) == (1, 0, 1)
    assert "fault mail_aboard" not in told


@pytest.mark.nightly
def test_a_recalled_robot_turns_round_on_its_way_and_brings_the_mail_back(run: SimulatedRun) -> None:
    service = with_service(run)
    loaded_and_at_post2(run)
    service.says(Recall(command_id="c1", reason="the mailroom closes early"))
    run.until(lambda: run.waits_for("wait_handover(return"))
    assert run.is_at("post1")
    run.shows(Purpose.LOAD)
    run.until(lambda: run.is_home)
    assert (run.missions.held.cargo, service.held) == ((), [])


def test_a_stop_to_charge_keeps_it_in_the_dock_through_a_kill_until_it_has_what_was_asked_for(tmp_path: Path) -> None:
    stop = Stop(id="c1", post="post5", action=StopAction.DOCK, until_ratio=0.7)
    first = SimulatedRun(tmp_path, battery_ratio=0.6)
    first.missions.give(Mission(id="m2", update=1, stops=(stop,)))
    first.until(lambda: "progress arrived" in first.told() and first.robot.docked)
    first.kill()

    second = SimulatedRun(tmp_path, battery_ratio=0.65)
    second.until(lambda: "progress done" in second.told())
    assert second.robot.docked
    assert 0.7 <= (second.mind.battery.ratio or 0.0) < 0.75
    second.close()


@pytest.mark.nightly
def test_a_robot_that_is_killed_in_its_dock_goes_on_charging_until_it_is_full(tmp_path: Path) -> None:
    first = SimulatedRun(tmp_path, battery_ratio=0.2)
    first.until(lambda: first.missions.held.recharging and first.robot.docked, 60)
    first.until(lambda: str(first.mind.battery.word) == "ok")
    first.kill()

    second = SimulatedRun(tmp_path)
    second.given_a_letter()
    second.passes(5)
    assert second.robot.docked, "it was there to be charged"
    second.until(lambda: not second.robot.docked)
    assert second.mind.battery.ratio is not None
    assert second.mind.battery.ratio > 0.95
    assert [one for one in second.told() if one.startswith("charge")] == [
        "charge low",
        "charge charging",
        "charge charged",
    ]
    second.close()


@pytest.mark.nightly
def test_a_robot_with_little_charge_begins_no_work_until_it_has_enough(tmp_path: Path) -> None:
    run = SimulatedRun(tmp_path, battery_ratio=0.4)
    run.given_a_letter()
    run.passes(5)
    assert run.robot.docked
    run.until(lambda: not run.robot.docked)
    assert run.mind.battery.ratio is not None
    assert 0.5 < run.mind.battery.ratio < 0.6
    run.close()


@pytest.mark.nightly
def test_a_detour_to_the_dock_gives_back_the_corridors_of_the_mission(run: SimulatedRun) -> None:
    service = with_service(run)
    loaded_and_at_post2(run)
    to_post4 = Leg(from_post="post3", to_post="post4")
    assert to_post4 in service.held
    run.robot.sag(0.2)
    run.until(lambda: run.is_at("post3"))
    run.passes(2)
    assert to_post4 not in service.held
    run.until(lambda: run.robot.docked)
    assert service.held == []


def test_whose_order_is_cancelled_while_it_waits_for_a_corridor_asks_for_none_and_keeps_none(run: SimulatedRun) -> None:
    service = with_service(run)
    service.lets_wait = True
    run.given_a_letter()
    run.until(lambda: run.waits_for("claim") and service.unanswered)
    (claim,) = service.unanswered
    service.says(Cancel(command_id="c1", order_id="o1"))
    run.until(lambda: not service.unanswered, 10)
    service.grant(claim)  # it was let in before the service heard that
    run.passes(2)
    assert (run.missions.held.grants, service.held) == ((), [])
    assert run.robot.docked


@pytest.mark.nightly
def test_a_paused_robot_gives_back_the_way_ahead(run: SimulatedRun) -> None:
    service = with_service(run)
    loaded_and_at_post2(run)
    assert len(service.held) > 1
    service.says(Pause(command_id="c1", reason="fire drill"))
    run.until(lambda: not service.held, 60)
    assert run.is_at("post2")
    service.says(Resume(command_id="c2"))
    run.until(lambda: run.waits_for("wait_handover(receive"))


@pytest.mark.nightly
def test_out_of_network_it_goes_as_far_as_it_may_waits_says_so_and_then_leaves_by_what_it_holds(
    run: SimulatedRun,
) -> None:
    service = with_service(run)
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    run.missions.claims.clear([leg for leg in service.held if leg.to_post == "post4"])
    run.passes(1)
    service.online = False
    run.shows(Purpose.LOAD)
    run.until(lambda: run.missions.held.cargo, 10)
    run.until(lambda: run.is_at("post3") and run.waits_for("claim"))
    run.passes(20)
    assert run.mind.why is not None
    assert (run.mind.why.sentence, run.mind.why.waiting_for) == ("Waiting at post3 for the network", "the network")
    assert "link_loss" in run.mind.hands.view.faults, "told, and no reason to stop"
    run.passes(60)
    assert run.is_at("post3"), "a service that is started anew is there again soon"
    run.until(lambda: run.is_at("post5"), 120)  # by the only corridor that it holds: perhaps there is network there
    service.online = True
    run.until(lambda: run.waits_for("wait_handover(receive"), 200)
    service.online = False
    run.shows(Purpose.RECEIVE)
    run.until(lambda: not run.missions.held.cargo, 10)


@pytest.mark.nightly
def test_somebody_who_does_not_make_way_closes_the_corridor(run: SimulatedRun) -> None:
    service = with_service(run)
    run.robot.world.obstacles.append(Person(1.0, 2.0))
    run.asks("", "visit(post1)")
    run.until(lambda: "fault no_way" in run.told())
    assert run.is_at("post3")
    assert run.visited == ["post5", "post3"]
    assert "fault way_blocked" in run.told()
    assert service.held[0] == Leg(from_post="post3", to_post="post2"), "for a while it keeps what it was granted"
    run.until(lambda: not service.held, 400)  # while it waits longer others may pass
    assert run.is_at("post3")
    run.robot.world.obstacles.clear()
    run.until(lambda: run.is_at("post1"), 1200)
    told = [one for one in run.told() if one.startswith("fault way_blocked")]
    assert len(told) % 2 == 0 and len(told) >= 2, "each time that it is closed is told to be over, too"


@pytest.mark.nightly
def test_a_robot_that_waits_for_a_way_goes_at_once_when_somebody_says_that_it_is_open(run: SimulatedRun) -> None:
    service = with_service(run)
    run.robot.world.obstacles.append(Person(1.0, 2.0))
    run.asks("", "visit(post1)")
    run.until(lambda: "fault no_way" in run.told())
    run.robot.world.obstacles.clear()
    told = run.told().count("fault way_blocked")
    wish = OpenWay(command_id="c1", ends=("post2", "post3"), looked_at=run.clock.utc())
    service.says(wish)
    run.passes(1)
    assert run.waits_for("turn") or run.waits_for("follow_line"), "it waits no longer"
    assert (run.told().count("fault way_blocked"), run.told().count("answer ")) == (told + 1, 1)
    assert not run.parts.navigator.closed.names
    run.until(lambda: run.is_at("post1"), 100)


@pytest.mark.nightly
def test_where_there_is_another_way_it_goes_round_a_closed_corridor(tmp_path: Path) -> None:
    run = SimulatedRun(tmp_path, map=str(SQUARE))
    service = with_service(run)
    run.robot.world.obstacles += [Person(1.0, 2.0), Person(2.0, 1.0)]
    run.asks("", "visit(c)")
    run.until(lambda: "fault way_blocked" in run.told())
    first = run.visited[-1]
    run.robot.world.obstacles.remove(Person(2.0, 1.0) if first == "d" else Person(1.0, 2.0))
    run.until(lambda: run.is_at("c"))
    assert run.visited == ["a", first, "a", {"d": "b", "b": "d"}[first], "c"]
    assert all(leg in service.held for leg in run.missions.held.grants)
    run.close()

    again = SimulatedRun(tmp_path, map=str(SQUARE))
    again.passes(1)
    assert again.told().count("fault way_blocked") == 1, "a restart does not open the corridor"
    again.close()


@pytest.mark.slow
def test_a_stop_from_the_service_holds_until_resume_and_the_mission_goes_on(run: SimulatedRun) -> None:
    service = with_service(run)
    run.given_a_letter()
    run.until(lambda: run.is_at("post3"))
    run.passes(3)
    service.says(EmergencyStop(command_id="c1", reason="a child plays there"))
    run.passes(3)
    assert run.mind.hands.view.sent.still
    assert run.mind.activity() == "stopped"
    service.says(Resume(command_id="c2"))
    run.until(lambda: run.waits_for("wait_handover(load"))
    assert run.missions.held.mission == LETTER
    assert run.told().count("answer ") == 2


@pytest.mark.nightly
def test_a_robot_whose_corridors_others_have_got_stands_until_a_marker_tells_it_where_it_is(run: SimulatedRun) -> None:
    service = with_service(run)
    run.given_a_letter()
    run.until(lambda: run.is_at("post3"))
    run.passes(3)
    service.says(Revoke(command_id="c1", reason="carried into the workshop"))
    service.held.clear()
    run.passes(3)
    assert (run.mind.hands.view.sent.still, run.mind.activity()) == (True, "stopped")
    service.says(Resume(command_id="c2"))
    stood_mm = run.robot.driven_mm
    run.passes(20)
    assert run.robot.driven_mm == stood_mm, "it may go, and does not know where it is"
    assert run.mind.why and run.mind.why.sentence == "Waiting to be put down at a post or in a dock"
    assert service.held == []
    run.robot.lift(True)
    run.passes(1)
    run.robot.place(start_pose(run.parts.navigator.campus, "post4"))
    run.robot.lift(False)
    run.passes(1)
    service.says(Resume(command_id="c3"))
    run.until(lambda: run.waits_for("wait_handover(load"))
    assert (run.told().count("fault revoked"), run.missions.held.revoked) == (2, False)


@pytest.mark.nightly
def test_switched_on_after_a_long_time_it_hears_first_whose_its_corridors_are(tmp_path: Path) -> None:
    first = SimulatedRun(tmp_path)
    with_service(first)
    first.given_a_letter()
    first.until(lambda: first.is_at("post3"))
    first.passes(3)
    first.kill()
    second = SimulatedRun(tmp_path)
    second.clock.advance(2000)
    service = with_service(second)
    service.online = False
    second.passes(10)
    stood_mm = second.robot.driven_mm
    assert stood_mm < 5, "it is in a corridor that was its own, and waits there"
    assert second.mind.why and second.mind.why.waiting_for == "the network"
    service.online = True
    second.until(lambda: second.is_at("post2"))
    second.close()


@pytest.mark.slow
def test_pressing_spot_twice_loads_but_never_hands_out(run: SimulatedRun) -> None:
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    press_twice(run)
    run.until(lambda: run.missions.held.cargo == ("o1",), 10)
    run.until(lambda: run.waits_for("wait_handover(receive"))
    press_twice(run)
    run.passes(5)
    assert run.missions.held.cargo == ("o1",)


def press_twice(run: SimulatedRun) -> None:
    run.passes(1)
    for _ in range(2):
        run.robot.press("spot")
        run.passes(0.7)


@pytest.mark.parametrize("switch", ["camera_dead", "camera_frozen"])
@pytest.mark.nightly
def test_a_camera_that_stays_away_ends_in_waiting_for_a_person(run: SimulatedRun, switch: str) -> None:
    """It neither tries for ever nor believes a picture of long ago; seen to, it delivers after all."""
    run.given_a_letter()
    run.until(lambda: run.waits_for("wait_handover(load"))
    run.shows(Purpose.LOAD)
    run.until(lambda: bool(run.missions.held.cargo) and run.waits_for("follow_line"))
    run.robot.set_fault(switch, True)
    run.passes(70)
    assert "fault camera_lost" in run.told()
    assert run.mind.why is not None
    assert "camera" in run.mind.why.sentence
    before = run.told(), run.robot.pose
    run.passes(300)
    assert (run.told(), run.robot.pose) == before, "it neither tries again nor rolls on"
    run.robot.set_fault(switch, False)
    run.until(lambda: run.waits_for("wait_handover(receive"))
    run.shows(Purpose.RECEIVE)
    run.until(lambda: run.is_home)
    assert not run.missions.held.cargo
