"""A robot on a map with bays: it stands in bays alone, and its reports on what it occupies are true."""

import math
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from maps import CampusMap
from maps.geometry import Point, distance_to_path_m
from protocol.to_server import Occupancy
from robot.scenarios.actors.actors import Actor
from robot.scenarios.loading import load_scenario
from robot.scenarios.stage import Stage

MAP = Path(__file__).parents[2] / "bays.toml"
LETTER = """
seed = {seed}
limit_s = 900
[map]
name = "{map}"
[[robot]]
name = "r1"
battery = 0.9
[[order]]
id = "letter"
from = "post1"
to = "post4"
{more}
[expect]
delivered = ["letter"]
"""
STANDS_AT_MOST_S = 6.0
"""A robot that only turns on a crossing stands still there between two moves, never longer."""
CLEAR_M = 0.40
"""A body of 348 mm so far from a post is clear of one that turns there."""


@dataclass
class Truth:
    """The poses of the robot's body, and each report on what it occupies with the pose at that moment."""

    track: CampusMap
    longest_on_a_crossing_s: float = 0.0
    reports: list[tuple[Occupancy, Point]] = field(default_factory=list)
    _stands_since_s: float | None = None

    def look(self, stage: Stage, now: float) -> None:
        actor = stage.actors[0]
        pose = actor.body.pose
        self._look_at_crossings(actor, Point(pose.x_m, pose.y_m), now)
        said = stage.service.sessions["r1"].occupies
        if said is not None and (not self.reports or said != self.reports[-1][0]):
            self.reports.append((said, Point(pose.x_m, pose.y_m)))

    def _look_at_crossings(self, actor: Actor, here: Point, now: float) -> None:
        crossings = (post.point for post in self.track.posts.values() if self.track.bays_of(post.name))
        if actor.rolls or min(math.dist(here, post) for post in crossings) > CLEAR_M:
            self._stands_since_s = None
        elif self._stands_since_s is None:
            self._stands_since_s = now
        else:
            self.longest_on_a_crossing_s = max(self.longest_on_a_crossing_s, now - self._stands_since_s)


def deliver(tmp_path: Path, seed: int, more: str = "") -> tuple[Stage, Truth]:
    path = tmp_path / "letter.toml"
    path.write_text(LETTER.format(seed=seed, map=MAP, more=more))
    with Stage(load_scenario(str(path))[0], tmp_path / "data", path) as stage:
        truth = Truth(stage.campus.track)
        stage.watchers.append(lambda now: truth.look(stage, now))
        ending = stage.run()
    assert [one.fate for one in ending.verdicts] == ["delivered"], ending.told
    assert ending.violations == []
    return stage, truth


@pytest.fixture(scope="module")
def delivered(tmp_path_factory: pytest.TempPathFactory) -> tuple[Stage, Truth]:
    return deliver(tmp_path_factory.mktemp("bays"), seed=3)


def test_mail_changes_hands_in_bays(delivered: tuple[Stage, Truth]):
    places = [place for _, place in delivered[0].actors[0].posts]
    assert places[0] == "post5_bay2"
    assert [place for place in places if "bay" in place] == ["post5_bay2", "post1_bay1", "post4_bay1", "post5_bay2"]


def test_it_stands_on_no_crossing(delivered: tuple[Stage, Truth]):
    assert delivered[1].longest_on_a_crossing_s < STANDS_AT_MOST_S


def test_what_it_says_to_occupy_is_true(delivered: tuple[Stage, Truth]):
    track, reports = delivered[1].track, delivered[1].reports
    assert len(reports) > 15
    for said, here in reports:
        away_m = math.dist(here, track.post(said.post).point)
        if said.where == "corridor":
            ends = track.corridor(said.post, said.towards or "")
            assert distance_to_path_m(here, ends.tape) < 0.05, said
            assert min(away_m, math.dist(here, track.post(said.towards or "").point)) > CLEAR_M, said
        else:
            assert away_m < (0.55 if said.evidence == "dock" else 0.08), said


def test_it_reports_every_place_on_its_way(delivered: tuple[Stage, Truth]):
    said = [(one.where, one.post) for one, _ in delivered[1].reports]
    first = said.index(("bay", "post1_bay1"))
    assert said[first : first + 8] == [
        ("bay", "post1_bay1"),
        ("crossing", "post1"),
        ("corridor", "post1"),
        ("crossing", "post2"),
        ("corridor", "post2"),
        ("crossing", "post3"),
        ("corridor", "post3"),
        ("crossing", "post4"),
    ]
