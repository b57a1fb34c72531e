"""A detour on a map with bays: the robot passes the post to which it was sent, and goes on by its own plan."""

from pathlib import Path

from protocol.parts import Leg
from protocol.to_robot import Detour
from protocol.to_server import Claim
from tests.robot.daemon.played_service import PlayedService
from tests.robot.daemon.simulated_run import SimulatedRun

RING = """
name = "ring"
title = "Four posts in a square, with bays"
{posts}
[[corridor]]
ends = ["a", "b"]
[[corridor]]
ends = ["b", "c"]
[[corridor]]
ends = ["c", "d"]
[[corridor]]
ends = ["a", "d"]
"""
POST = """
[[post]]
name = "{0}"
x_m = {1}
y_m = {2}
[[post.bay]]
bearing_deg = {3}
"""
AT_HOME = """dock = true
home = true
[[post.bay]]
bearing_deg = 180.0
"""


SECOND_BAY = """[[post.bay]]
bearing_deg = 45.0
"""


def ring(folder: Path, more_at_b: str = "") -> Path:
    corners = ("a", 0.0, 0.0, 250.0), ("b", 3.0, 0.0, 315.0), ("c", 3.0, 3.0, 45.0), ("d", 0.0, 3.0, 135.0)
    a, b, *others = (POST.format(*corner) for corner in corners)
    file = folder / "ring.toml"
    file.write_text(RING.format(posts="".join((a, AT_HOME, b, more_at_b, *others))))
    return file


class SendsAside(PlayedService):
    def detour(self, claim: Claim, *legs: Leg) -> None:
        self.held += legs
        self.missions.memory.grant(legs)
        self.missions.memory.turn_aside(legs[-1])
        self.says(Detour(claim_id=claim.claim_id, legs=legs, reason="Others have to pass."))


class SendsRound(SendsAside):
    """It sends the robot to b by way of d and c. It lets it go no further than its next corridor or bay."""

    def grant(self, claim: Claim) -> None:
        *before, last = claim.legs[: 2 if claim.legs[0].from_post.startswith("a_bay") else 1]
        instead = {("a", "b"): "d", ("d", "a"): "c"}.get((last.from_post, last.to_post))
        if instead is None:
            super().grant(claim.model_copy(update={"legs": (*before, last)}))
        else:
            self.detour(claim, *before, Leg(from_post=last.from_post, to_post=instead))


def test_it_passes_the_post_to_which_it_was_sent_and_goes_on_from_there(tmp_path: Path) -> None:
    run = SimulatedRun(tmp_path, map=str(ring(tmp_path)))
    run.missions.join(SendsRound(run.missions))
    run.asks("", "visit(b)")
    run.until(lambda: run.is_at("b"), 120)
    assert run.visited == ["a_bay1", "a", "d", "c", "b"]
    run.until(lambda: run.bays[-1:] == ["b_bay1"], 60)
    run.close()


class SendsIntoSecondBay(SendsAside):
    """It sends the robot into the second bay of b, and lets it go no further than two corridors."""

    def grant(self, claim: Claim) -> None:
        first = claim.legs[0]
        if (first.from_post, first.to_post) == ("b", "b_bay1"):
            self.detour(claim, Leg(from_post="b", to_post="b_bay2"))
        else:
            super().grant(claim.model_copy(update={"legs": claim.legs[:2]}))


def test_sent_into_another_bay_of_the_post_it_is_there_and_does_not_drive_on(tmp_path: Path) -> None:
    run = SimulatedRun(tmp_path, map=str(ring(tmp_path, SECOND_BAY)))
    run.missions.join(SendsIntoSecondBay(run.missions))
    run.asks("", "visit(b)")
    run.until(lambda: run.bays[-1:] == ["b_bay2"], 120)
    run.until(lambda: run.is_home, 120)
    assert run.visited == ["a_bay1", "a", "b", "b_bay2", "b", "a", "a_bay1"]
    assert "find_line" not in run.did
    run.close()
