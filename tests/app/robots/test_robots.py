"""Robots as people see them, and how a robot comes to have a token."""

import asyncio
import sys
from asyncio.subprocess import PIPE, create_subprocess_exec
from datetime import datetime, timedelta
from os import environ
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.core.settings import Settings
from app.models import RobotRow
from app.robots.errors import RobotExists, RobotNameInvalid, UnknownRobot
from app.robots.link.tokens import token_of
from app.robots.service import enrol, new_token
from protocol.clock import SteppedClock
from protocol.parts import Battery, Position
from tests.app.robots.playing import PlayedRobot, Service

ROOT = Path(__file__).parents[3]


def test_robots_are_for_people_who_are_signed_in(anonymous: TestClient) -> None:
    answer = anonymous.get("/api/v1/robots")
    assert (answer.status_code, answer.json()["code"]) == (401, "not_signed_in")


def test_everybody_who_is_signed_in_sees_all_robots(app: FastAPI, sender: TestClient, clock: SteppedClock) -> None:
    async def enrol_two() -> None:
        async with app.state.parts.database.transaction() as session:
            for name in ("r2", "r1"):
                await enrol(session, clock, name)

    assert sender.get("/api/v1/robots").json() == {"items": [], "next": None}
    assert sender.portal is not None
    sender.portal.call(enrol_two)
    robots = sender.get("/api/v1/robots").json()["items"]
    assert [(robot["name"], robot["online"], robot["last_seen"]) for robot in robots] == [
        ("r1", False, None),
        ("r2", False, None),
    ]


async def test_a_robot_is_seen_at_posts_and_expected_in_an_interval(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet(position=Position(post="post2", previous="post1", towards="post3", seen_at=clock.utc()))
        async with service.app.state.parts.database.reading() as session:
            (view,) = [one.model_dump(mode="json") for one in await service.app.state.parts.fleet.views(session)]
    assert view["last_seen"]["post"] == "post2"
    assert view["last_seen"]["previous"] == "post1"
    assert view["expected"]["post"] == "post3"
    first, last = (datetime.fromisoformat(view["expected"][end]) for end in ("from", "to"))
    drive_s = 2.0 / service.app.state.parts.settings.assumed_speed_m_s
    assert clock.utc() + timedelta(seconds=drive_s) == first < last
    assert view["battery"] == {"ratio": 0.9, "charging": False, "charges_to": None}


async def test_of_a_robot_that_charges_it_is_said_when_it_will_have_enough(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet("post5", battery=Battery(ratio=0.5, charging=True))
        async with service.app.state.parts.database.reading() as session:
            (view,) = await service.app.state.parts.fleet.views(session)
    assert view.battery is not None and view.battery.charges_to is not None
    assert view.battery.charges_to.ratio == 0.8
    # Of three hours: 0.85 at full current and the rest ever slower, which takes as long as 0.41 would, are 1.26.
    assert timedelta(minutes=42) < view.battery.charges_to.at - clock.utc() < timedelta(minutes=44)


async def test_enrolling_twice_or_under_an_impossible_name_is_refused_by_name(service: Service) -> None:
    await service.enrol("r1")
    with pytest.raises(RobotExists, match="enrolled already"):
        await service.enrol("r1")
    for name in ("", "-r", "robot one", "r" * 65, "rébot"):
        with pytest.raises(RobotNameInvalid, match="no name for a robot"):
            await service.enrol(name)
    assert len(await service.rows(RobotRow)) == 1


async def test_a_new_token_makes_the_older_ones_worthless(service: Service, clock: SteppedClock) -> None:
    database = service.app.state.parts.database
    old = await service.enrol("r1")
    async with database.transaction() as session:
        new = await new_token(session, clock, "r1")
    async with database.transaction() as session:
        known = await token_of(session, f"Bearer {new}")
        assert known is not None
        assert known.robot == "r1"
        assert await token_of(session, f"Bearer {old}") is None
        with pytest.raises(UnknownRobot, match="r9"):
            await new_token(session, clock, "r9")


async def test_the_token_of_one_robot_opens_no_other(service: Service, clock: SteppedClock) -> None:
    tokens = [await service.enrol(name) for name in ("r1", "r2")]
    mixed = "_".join([*tokens[0].split("_", 2)[:2], tokens[1].split("_", 2)[2]])
    async with service.app.state.parts.database.transaction() as session:
        known = [await token_of(session, f"Bearer {token}") for token in tokens]
        assert [row and row.robot for row in known] == ["r1", "r2"]
        assert await token_of(session, f"Bearer {mixed}") is None


@pytest.mark.slow
async def test_the_command_prints_the_token_once_and_says_what_is_wrong_in_words(settings: Settings) -> None:
    env = {**environ, "CAMPUS_MAIL_DATA": str(settings.data), "PYTHONPATH": str(ROOT)}

    async def command(name: str) -> tuple[int, str, str]:
        arguments = ("-m", "app", "robots", "enrol", name, "--token")
        process = await create_subprocess_exec(sys.executable, *arguments, env=env, cwd=ROOT, stdout=PIPE, stderr=PIPE)
        said, complained = await process.communicate()
        return process.returncode or 0, said.decode().strip(), complained.decode()

    code, token, _ = await command("r1")
    assert code == 0
    prefix, secret = token.split("_", 2)[1:]
    assert (len(prefix), len(secret)) == (8, 43)
    code, said, complained = await command("r1")
    assert (code, said) == (2, "")
    assert "enrolled already" in complained
    assert "Traceback" not in complained


async def test_two_tokens_are_never_alike(service: Service, clock: SteppedClock) -> None:
    async with service.app.state.parts.database.transaction() as session:
        tokens = [await enrol(session, clock, f"r{number}") for number in range(20)]
    assert len({token.split("_", 2)[2] for token in tokens}) == 20


async def test_a_wrong_token_is_refused_while_another_transaction_writes(service: Service, robot: PlayedRobot) -> None:
    """A client that tries tokens must not hold up writers, nor wait for them."""
    wrong = f"cmr_00000000_{'x' * 43}"
    async with service.app.state.parts.database.transaction(), asyncio.timeout(5), robot.connected(service.url, wrong):
        assert await robot.close_code() == 4401
