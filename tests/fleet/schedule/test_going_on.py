"""Several corridors granted at once: as far as no other robot goes before."""

from random import Random

from fleet.schedule.controller import Granted, TrafficController, Waits
from fleet.schedule.journey import Goal
from fleet.schedule.validation import problems
from tests.fleet.schedule.test_controller import line

WAY = [("b", "c"), ("c", "d")]


def alone_and_let_in() -> TrafficController:
    controller = TrafficController(line(5))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    controller.joins("r2", post="e", home="e", at_home=True, now_s=0.0)
    assert controller.give("r1", [Goal(3, 10.0, key="d")], 0.0)
    assert isinstance(controller.claims("r1", "a", "b", 0.0), Granted)
    return controller


def is_sound(controller: TrafficController, now_s: float) -> bool:
    return problems(controller.network, controller.tasks(now_s), controller.journeys(now_s)) == []


def test_a_robot_that_meets_no_other_gets_its_whole_way_and_all_of_it_is_its_own_until_it_is_through() -> None:
    controller = alone_and_let_in()
    assert [lane.end for lane in controller.goes_on("r1", WAY, 0.0)] == [2, 3]
    assert is_sound(controller, 0.0)
    assert controller.give("r2", [Goal(1, 10.0, key="b")], 1.0), "behind it"
    assert is_sound(controller, 5_000.0), "however late it is"
    assert isinstance(controller.claims("r2", "e", "d", 2.0), Waits), "the bay at d is kept"
    for start, end, now_s in (("a", "b", 100.0), ("b", "c", 200.0), ("c", "d", 300.0)):
        assert controller.grants(now_s) == []
        controller.cleared("r1", start, end, now_s)
        assert is_sound(controller, now_s)
    assert controller.tasks(300.0)["r1"].start.post == 3
    controller.served("r1", "d", 310.0)
    assert controller.leads("r1") is not None, "home, before the other comes in"


def test_only_so_far_is_granted_as_no_robot_goes_before() -> None:
    controller = TrafficController(line(5, bays=2))
    controller.joins("r1", post="a", home="a", at_home=True, now_s=0.0)
    controller.joins("r2", post="e", home="e", at_home=True, now_s=0.0)
    assert controller.give("r2", [Goal(3, 10.0, key="d")], 0.0)
    assert isinstance(controller.claims("r2", "e", "d", 0.0), Granted)
    controller.cleared("r2", "e", "d", 100.0)
    assert controller.give("r1", [Goal(4, 10.0, key="e")], 101.0)
    assert isinstance(controller.claims("r1", "a", "b", 101.0), Granted)
    further = controller.goes_on("r1", [*WAY, ("d", "e")], 101.0)
    assert [lane.end for lane in further] == [2, 3], "d–e is entered by r2 on its way home first"
    assert is_sound(controller, 101.0)


def test_a_frozen_robot_keeps_all_that_it_was_granted() -> None:
    controller = alone_and_let_in()
    controller.goes_on("r1", WAY, 0.0)
    controller.cleared("r1", "a", "b", 100.0)
    controller.freeze("r1", 150.0)
    open_now = controller.network
    assert [len(lanes) for lanes in open_now.lanes] == [1, 1, 0, 1, 1], "b–c and c–d are closed, the others are not"
    assert open_now.bays == (1, 0, 0, 0, 1), "where it may stand"


def test_what_was_granted_before_a_restart_is_held_after_it() -> None:
    controller = TrafficController(line(5))
    controller.joins("r2", post="e", home="e", at_home=True, now_s=0.0)
    controller.joins("r1", post="a", home="a", at_home=False, now_s=0.0, towards=["b", "c", "d"])
    assert controller.give("r2", [Goal(0, 10.0, key="a")], 0.0)
    assert is_sound(controller, 0.0)
    assert isinstance(controller.claims("r2", "e", "d", 1.0), Waits)


def test_robots_that_go_on_as_far_as_they_may_never_meet_and_all_arrive() -> None:
    for seed in range(12):
        rng, network = Random(seed), line(6, bays=1 + seed % 2)
        controller, names = TrafficController(network, rng), ["r1", "r2", "r3"]
        homes = dict(zip(names, (0, 2, 5), strict=True))
        for name, home in homes.items():
            controller.joins(name, post="abcdef"[home], home="abcdef"[home], at_home=True, now_s=0.0)
            assert controller.give(name, [Goal(rng.randrange(6), 10.0, key=name)], 0.0)
        assert drive_until_home(controller, names, rng) == set(names), seed


def drive_until_home(controller: TrafficController, names: list[str], rng: Random) -> set[str]:
    """One thing at a time, in any order: a robot leaves a corridor, or serves, or claims and goes on."""
    now_s, ahead, home = 0.0, {name: list[tuple[str, str]]() for name in names}, set[str]()
    for _ in range(400):
        now_s, name = now_s + rng.uniform(1.0, 120.0), rng.choice(names)
        if ahead[name]:
            controller.cleared(name, *ahead[name].pop(0), now_s)
        post = controller.tasks(now_s)[name].start.post
        if not ahead[name] and (goals := controller.goals(name)) and goals[0].post == post:
            controller.served(name, goals[0].key, now_s)
        if not ahead[name]:
            ahead[name] = claimed(controller, name, now_s)
        held = [frozenset(leg) for legs in ahead.values() for leg in legs]
        assert len(held) == len(set(held)), "a corridor is one robot's"
        assert is_sound(controller, now_s)
        if not ahead[name] and not controller.goals(name) and controller.leads(name) is None:
            home.add(name)
        if len(home) == len(names):
            break
    return home


def claimed(controller: TrafficController, name: str, now_s: float) -> list[tuple[str, str]]:
    posts = controller.network.posts
    lane = controller.leads(name)
    if lane is None:
        return []
    first = (posts[lane.start], posts[lane.end])
    if not isinstance(controller.claims(name, *first, now_s), Granted):
        return []
    way = [
        (posts[leg.lane.start], posts[leg.lane.end]) for leg in controller.journeys(now_s)[name].legs[1:] if leg.lane
    ]
    return [first, *((posts[one.start], posts[one.end]) for one in controller.goes_on(name, way, now_s))]
