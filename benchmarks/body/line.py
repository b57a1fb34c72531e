"""Following a taped line: driven to the end, mean speed, samples lost, speeds on the wire.

Tape 24 mm, diodes 18 mm apart, 1 % of the reads of a diode flipped, gaps of 20 mm every 0.6 to 1.4 m, wheels with 60 ms
lag, ±10 mm/s ripple and 2 % error of their size. The robot is put down on the line at the beginning of a track and has
to stop at the post at its end.

- *completed*: follow_line ended with this post, and the axle stands within 50 mm of it.
- *mean speed*: way of the axle over the floor from the start of follow_line to its end, over the time between: the
  start, the braking before the post and 0.2 s of standing there are in it.
- *lost*: one vote (of the diodes at a drive tick, 50 a second) with none of the three over the line, from the first
  movement until the axle reaches the post. Each gap in the tape costs some; the tape goes on behind the last post.
- *slow*: a drive command on the wire with a wheel between 0 and 30 mm/s, forwards or backwards; of all that were sent.
- *searched*: share of the driving time in which the line was looked for.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import mean
from typing import Any

from benchmarks.body.report import Samples, Wanted, say
from benchmarks.body.tracks import TRACKS, Stepped, beside_mm, track_map
from benchmarks.body.turns import measure_turns
from maps import Point
from robot.skills import Done, FollowLine

LEADS_MM = (60.0, 0.0)
CRUISE_MM_S = {60.0: 200.0, 0.0: 100.0}
"""With the diodes on the axle the robot sees no heading and has to go slower."""
END_WITHIN_M = 0.05
SLOWEST_MM_S = 30
ON_TWO = ("straight", "s_600_400")

WANTED = (
    Wanted("lead_60.completed_share", at_least=1.0),
    Wanted("lead_60.mean_speed_mm_s", at_least=150.0, unit="mm/s"),
    Wanted("lead_60.lost_share", at_most=0.05, unit="of samples"),
    Wanted("lead_60.slow_commands", at_most=0, unit="commands"),
    Wanted("lead_0.completed_share", at_least=0.95, unit="of the first two tracks"),
    Wanted("lead_0.mean_speed_mm_s", at_least=80.0, at_most=120.0, unit="mm/s"),
    Wanted("lead_0.slow_commands", at_most=0, unit="commands"),
    Wanted("turns.test_track.completed_share", at_least=1.0, unit="of all turns at all posts"),
    Wanted("turns.carleton.completed_share", at_least=1.0, unit="of all turns at all posts"),
)


@dataclass
class Ride:
    """One robot on one track."""

    track: str
    lead_mm: float
    seed: int
    outcome: str = ""
    completed: bool = False
    speed_mm_s: float = 0.0
    votes: int = 0
    lost: int = 0
    searching: int = 0
    slow_commands: int = 0
    path: list[Point] = field(default_factory=list)
    offsets_mm: list[float] = field(default_factory=list)

    @property
    def lost_share(self) -> float:
        return self.lost / max(1, self.votes)


def ride(track: str, lead_mm: float, seed: int, cruise_mm_s: float | None = None) -> Ride:
    """Drive it once."""
    campus = track_map(track)
    one, stepped = Ride(track, lead_mm, seed), Stepped(campus, "a:b", seed, lead_mm)
    end = campus.post("b").point
    line = campus.corridor("a", "b").tape

    def watch() -> None:
        view, pose = stepped.loop.view, stepped.robot.pose
        one.path.append(Point(pose.x_m, pose.y_m))
        if view.odometry.travelled_mm and not view.sent.still:
            one.votes += 1
            one.lost += not any(view.reading)
            one.searching += view.searching

    try:
        began_s, began_mm = stepped.now, stepped.robot.driven_mm
        follow = FollowLine(campus, "a", cruise_mm_s or CRUISE_MM_S[lead_mm], stepped.shape)
        outcome = stepped.do(follow, watch)
        pose = stepped.robot.pose
        near = abs(complex(pose.x_m - end.x_m, pose.y_m - end.y_m)) < END_WITHIN_M
        one.outcome, one.completed = str(outcome), near and isinstance(outcome, Done) and outcome.result == "b"
        one.speed_mm_s = (stepped.robot.driven_mm - began_mm) / (stepped.now - began_s)
        one.slow_commands = sum(any(0 < abs(speed) < SLOWEST_MM_S for speed in pair) for pair in stepped.wire.commands)
        one.offsets_mm = [beside_mm(line, point) for point in one.path]
    finally:
        stepped.close()
    return one


def measure(samples: Samples) -> dict[str, Any]:
    """Figures by lead and track; the bounds for a lead of 0 hold for the first two tracks."""
    rides: list[Ride] = []
    for lead_mm in LEADS_MM:
        for track in TRACKS:
            some = [ride(track, lead_mm, seed) for seed in samples.some_seeds()]
            say(f"  lead {lead_mm:g} mm, {track}: {_line(some)}")
            rides += some
    _plot(rides, samples.plots)
    leads = {f"lead_{lead:g}": _lead([one for one in rides if one.lead_mm == lead]) for lead in LEADS_MM}
    return leads | {"turns": measure_turns(samples.first_seed)}


def _lead(rides: Sequence[Ride]) -> dict[str, Any]:
    judged = [one for one in rides if one.lead_mm or one.track in ON_TWO]
    tracks = {track: figures([one for one in rides if one.track == track]) for track in TRACKS}
    return figures(judged) | {"tracks": tracks}


def figures(rides: Sequence[Ride]) -> dict[str, Any]:
    """Of these rides together. The lost share is the mean over the rides."""
    return {
        "rides": len(rides),
        "completed_share": mean(one.completed for one in rides),
        "mean_speed_mm_s": mean(one.speed_mm_s for one in rides),
        "slowest_ride_mm_s": min(one.speed_mm_s for one in rides),
        "lost_share": mean(one.lost_share for one in rides),
        "worst_ride_lost_share": max(one.lost_share for one in rides),
        "searched_share": mean(one.searching / max(1, one.votes) for one in rides),
        "slow_commands": sum(one.slow_commands for one in rides),
        "farthest_off_mm": max(max(map(abs, one.offsets_mm)) for one in rides),
        "failed_seeds": [f"{one.track} {one.seed}: {one.outcome}" for one in rides if not one.completed],
    }


def _line(rides: Sequence[Ride]) -> str:
    of = figures(rides)
    shown = ("completed_share", "mean_speed_mm_s", "lost_share", "searched_share", "farthest_off_mm", "slow_commands")
    return ", ".join(f"{name} {of[name]:.3g}" for name in shown)


def _plot(rides: Sequence[Ride], folder: Path) -> None:
    """Paths on their tape, and the axle's offset over time; a picture for each lead."""
    from matplotlib.figure import Figure

    for lead in LEADS_MM:
        figure = Figure(figsize=(12, 10), layout="constrained")
        for row, track in enumerate(TRACKS):
            paths, offsets = figure.add_subplot(3, 2, 2 * row + 1), figure.add_subplot(3, 2, 2 * row + 2)
            paths.plot(*zip(*track_map(track).corridor("a", "b").tape, strict=True), color="0.8", linewidth=6)
            paths.set(title=f"{track}, lead {lead:g} mm", xlabel="m", ylabel="m", aspect="equal", adjustable="datalim")
            offsets.set(title="offset of the axle from the line", xlabel="s", ylabel="mm, left positive")
            for one in rides:
                if (one.lead_mm, one.track) == (lead, track):
                    paths.plot(*zip(*one.path, strict=True), linewidth=0.5)
                    offsets.plot([i / 50 for i in range(len(one.offsets_mm))], one.offsets_mm, linewidth=0.5)
        figure.savefig(folder / f"line_lead_{lead:g}.svg")
