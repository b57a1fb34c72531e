"""What the robot says to occupy: each place once, through a restart, and anew when it was taken away."""

from datetime import UTC, datetime

import pytest

from protocol.to_server import Occupancy
from robot.mission.occupancy import OccupancyReports
from robot.mission.outbox import Outbox
from robot.mission.store import Store

NOW = datetime(2026, 1, 5, 9, tzinfo=UTC)


@pytest.fixture
def store(tmp_path):
    store = Store(tmp_path / "robot.db")
    yield store
    store.close()


def reports(store: Store) -> OccupancyReports:
    return OccupancyReports(store, Outbox(store), lambda: NOW)


def told(store: Store) -> list[tuple[str, str, str | None]]:
    messages = [kept.message for kept in Outbox(store).pending()]
    assert all(isinstance(message, Occupancy) for message in messages)
    return [(one.where, one.post, one.towards) for one in messages]


def test_each_place_is_reported_once(store):
    said = reports(store)
    assert said.report("crossing", "post3", None, "marker")
    assert not said.report("crossing", "post3", None, "map")
    assert said.report("corridor", "post3", "post4", "distance", 452)
    assert said.report("corridor", "post4", "post3", "distance", 452)
    assert told(store) == [
        ("crossing", "post3", None),
        ("corridor", "post3", "post4"),
        ("corridor", "post4", "post3"),
    ]


def test_after_a_restart_it_is_not_reported_again(store):
    reports(store).report("bay", "post4_bay1", None, "marker")
    assert not reports(store).report("bay", "post4_bay1", None, "marker")
    assert len(told(store)) == 1


def test_a_robot_that_was_taken_away_reports_the_same_place_anew(store):
    said = reports(store)
    said.report("bay", "post4_bay1", None, "marker")
    said.forget()
    assert reports(store).report("bay", "post4_bay1", None, "marker")


def test_what_is_not_on_the_disk_was_not_said(store):
    said = reports(store)
    with pytest.raises(RuntimeError, match="power cut"), store.transaction():
        said.report("bay", "post4_bay1", None, "marker")
        raise RuntimeError("power cut")
    assert told(store) == []
    assert reports(store).report("bay", "post4_bay1", None, "marker")
