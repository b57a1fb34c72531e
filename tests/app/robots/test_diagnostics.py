"""Watching a robot: what it senses and thinks reaches who watches it, and leaves nothing behind."""

import json
from datetime import timedelta
from itertools import pairwise
from pathlib import Path

from fastapi import FastAPI

from app.accounts.sign_in.service import set_roles
from app.models import Alarm, BatterySample, Person, RobotRow, Role
from app.realtime.feed import WHISPERED, FeedEvent, LocalFeed
from app.robots.battery import SHOWN, samples_since
from app.robots.diagnostics import HOLDS_S, LiveDiagnostics
from app.robots.service import enrol
from protocol.clock import SteppedClock
from protocol.diagnostics import Diagnostics
from protocol.parts import Activity, Battery, Position
from protocol.to_robot import Watch
from protocol.to_server import Snapshot
from robot.core.config import BatterySettings
from tests.app.conftest import SENDER, Browser, Mailroom
from tests.app.robots.playing import PlayedRobot, Service, until

EXAMPLE = Path(__file__).parents[3] / "protocol/examples/insight.json"
INSIGHT = Diagnostics.model_validate_json(json.dumps(json.loads(EXAMPLE.read_text())["body"]))
MIRA = Person(id="mira", email="mira@campus.example", name="Mira", roles=["maintainer", "member"])
DAN = Person(id="dan", email="dan@campus.example", name="Dan", roles=["dispatcher", "member"])


async def test_a_robot_is_asked_to_tell_and_only_who_watches_hears_it(service: Service, robot: PlayedRobot) -> None:
    fleet, feed = service.app.state.parts.fleet, service.app.state.parts.feed
    token = await service.enrol("r1")
    other = Person(id="otto", email="otto@campus.example", name="Otto", roles=["maintainer"])
    with feed.listening(MIRA) as mira, feed.listening(other) as otto, feed.listening(DAN) as dan:
        async with robot.connected(service.url, token):
            await robot.greet(understands=("watch",))
            last_id = feed.last_id
            assert fleet.watching.watch("r1", "mira")
            assert fleet.watching.watch("r1", "dan"), "who has not the role hears nothing all the same"
            assert (await robot.hear("watch")).body == Watch(for_s=HOLDS_S, whole=True)
            await robot.say(INSIGHT)

            async def shown() -> bool:
                return any(one.happening.event == "insight" for one in list(mira._queue))

            await until(shown)
        (heard,) = [one for one in list(mira._queue) if one.happening.event == "insight"]
        told = json.loads(heard.wire.decode().partition("data: ")[2])
        assert (told["robot"], told["insight"]) == ("r1", json.loads(INSIGHT.model_dump_json()))
        assert b"\nid:" not in heard.wire, "a page that comes back is not given it again"
        assert not [one for queue in (otto, dan) for one in list(queue._queue) if one.happening.event == "insight"]
        assert last_id.partition("-")[0] == feed.last_id.partition("-")[0]


async def test_a_robot_that_was_away_is_asked_again_and_an_older_one_never(service: Service) -> None:
    watching = service.app.state.parts.fleet.watching
    for name, understands in (("r1", ("confirm", "watch")), ("r2", ("confirm",))):
        robot = PlayedRobot(service.app.state.parts.clock, name, journal=f"journal-of-{name}")
        token = await service.enrol(name)
        assert not watching.watch(name, "mira"), "it is not there"
        async with robot.connected(service.url, token):
            await robot.greet(understands=understands)
            if "watch" in understands:
                again = (await robot.hear("watch")).body
                assert isinstance(again, Watch)
                assert again.whole
                assert 0 < again.for_s <= HOLDS_S
            assert watching.watch(name, "mira") == ("watch" in understands)
            await robot.say(Snapshot(position=Position(), activity=Activity.IDLE, battery=Battery(ratio=0.5)))
        assert "watch" not in {one.type for one in robot.heard} or name == "r1"


def test_who_says_no_more_that_they_watch_is_forgotten() -> None:
    now_s, asked = [0.0], list[Watch]()

    class Seats:
        def watch(self, robot: str, watch: Watch) -> bool:
            asked.append(watch)
            return True

    watching = LiveDiagnostics(Seats(), LocalFeed(), lambda: now_s[0])
    watching.watch("r1", "mira")
    now_s[0] = 10.0
    watching.watch("r1", "mira")
    watching.watch("r1", "otto")
    assert [one.whole for one in asked] == [True, False, True], "all beliefs for each who begins to look"
    now_s[0] = 10.0 + HOLDS_S
    assert watching.wanted_of("r1") is None
    watching.watch("r1", "mira")
    assert asked[-1].whole


def test_what_is_of_the_moment_pushes_nothing_out_and_is_left_out_first() -> None:
    feed = LocalFeed()
    with feed.listening(MIRA) as mira:
        feed.publish(FeedEvent("robot", {"name": "r1"}))
        before = feed.last_id
        for _ in range(3 * WHISPERED):
            feed.whisper(FeedEvent("insight", {}, role=Role.MAINTAINER), {"mira"})
        feed.publish(FeedEvent("robot", {"name": "r2"}))
        assert mira.qsize() == WHISPERED + 1
        missed = feed.missed(MIRA, before)
    assert missed is not None
    assert [one.happening.data for one in missed] == [{"name": "r2"}]


async def test_a_robots_charge_is_noted_once_a_minute_and_when_charging_begins(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")

    async def tell(ratio: float, charging: bool = False) -> None:
        battery = Battery(ratio=ratio, charging=charging)
        await robot.say(Snapshot(position=Position(), activity=Activity.IDLE, battery=battery))

        async def known() -> bool:
            return bool((await service.row(RobotRow, name="r1")).battery_ratio == ratio)

        await until(known)

    async with robot.connected(service.url, token):
        await robot.greet()
        for ratio in (0.89, 0.88):
            clock.advance(10)
            await tell(ratio)
        clock.advance(45)
        await tell(0.87)
        clock.advance(1)
        await tell(0.86, charging=True)
    rows = sorted(await service.rows(BatterySample), key=lambda row: row.at)
    assert [(row.ratio, row.charging) for row in rows] == [(0.9, False), (0.87, False), (0.86, True)]


async def test_a_long_history_is_thinned_and_keeps_its_ends_and_every_change(service: Service) -> None:
    await service.enrol("r1")
    begin = service.app.state.parts.clock.utc()
    async with service.app.state.parts.database.transaction() as session:
        session.add_all(
            BatterySample(robot="r1", at=begin + timedelta(minutes=n), ratio=n / 2000, charging=700 <= n < 705)
            for n in range(1500)
        )
    async with service.app.state.parts.database.reading() as session:
        shown = await samples_since(session, "r1", begin)
        later = await samples_since(session, "r1", begin + timedelta(minutes=1400))
    assert SHOWN <= len(shown) <= SHOWN + 4
    assert [shown[0][0], shown[-1][0]] == [begin, begin + timedelta(minutes=1499)]
    changes = [at for (_, _, before), (at, _, charging) in pairwise(shown) if charging != before]
    assert changes == [begin + timedelta(minutes=700), begin + timedelta(minutes=705)]
    assert len(later) == 100, "few are shown as they are"


def test_maintainers_see_one_robots_faults_and_charge_and_are_told_whether_it_tells(
    app: FastAPI, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    now = clock.utc()

    async def begin() -> None:
        async with app.state.parts.database.transaction() as session:
            set_roles(await app.state.parts.sign_in_service.person(session, SENDER, now), {Role.MAINTAINER}, set())
            for name in ("r1", "r2"):
                if name == "r2":
                    await enrol(session, clock, name)
                session.add(Alarm(robot=name, name="bump", reason=f"{name} was bumped", at=now))
            session.add(BatterySample(robot="r1", at=now - timedelta(hours=30), ratio=0.9, charging=False))
            session.add(BatterySample(robot="r1", at=now - timedelta(hours=2), ratio=0.4, charging=True))

    mailroom.call(begin)
    assert [one["reason"] for one in sender.get("/api/v1/alarms?robot=r1").json()["items"]] == ["r1 was bumped"]
    of_a_day = sender.get("/api/v1/robots/r1/battery").json()
    assert [(one["ratio"], one["charging"]) for one in of_a_day["samples"]] == [(0.4, True)]
    assert of_a_day["low_ratio"] == BatterySettings().low_ratio, "the robots' own setting, unless theirs says otherwise"
    longer = sender.get("/api/v1/robots/r1/battery", params={"since": (now - timedelta(days=2)).isoformat()}).json()
    assert [one["ratio"] for one in longer["samples"]] == [0.9, 0.4]
    watch = sender.post("/api/v1/robots/r1/watch", headers={"Sec-Fetch-Site": "same-origin"}).json()
    assert watch == {"robot": "r1", "online": False, "tells": False, "for_s": HOLDS_S}
    assert sender.get("/api/v1/robots/r3/battery").json()["code"] == "unknown_robot"
