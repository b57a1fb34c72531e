"""SIGKILL of the real daemon at random moments of missions with mail: what the restarted one knows, and what becomes of
the mail.

Each mission has a robot of its own: a process with a simulated body that is joined to a service over a WebSocket and
runs on a shared clock faster than the machine's. The simulated body stands still at once when the daemon dies, and the
next start goes on from there (`robot/ops/simulated_world.py`); a real base rolls on until systemd has sent stop bytes
after the daemon (`ExecStopPost`), and without end if its computer has died.
"""

import asyncio
from collections import Counter, deque
from collections.abc import Iterable
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.body.kills_mission import Mission
from benchmarks.body.kills_moments import MOMENTS, Moment
from benchmarks.body.report import Samples, Wanted, say

WANTED = (
    Wanted("known_share", at_least=1.0, unit="of the restarts"),
    Wanted("told_twice", at_most=0),
    Wanted("handovers_lost", at_most=0),
    Wanted("handovers_false", at_most=0),
    Wanted("delivered_share", at_least=1.0, unit="of the missions"),
)
KILLS_OF_A_MISSION = (3, 8)


def measure(samples: Samples) -> dict[str, Any]:
    """Kill `samples.kills` times. A seed fixes what a moment waits for; the step it hits depends on the machine too."""
    missions = asyncio.run(_missions(samples))
    restarts = sum(len(mission.killed) for mission in missions)
    knew = sum(mission.knew for mission in missions)
    return {
        "kills": restarts,
        "moments": dict(Counter(moment.name for mission in missions for moment in mission.killed)),
        "missions": len(missions),
        "network_breaks": sum(mission.service.breaks for mission in missions),
        "known_share": knew / restarts if restarts else 0.0,
        "told_twice": sum(len(mission.told_twice) for mission in missions),
        "handovers_lost": sum(mission.handovers_lost for mission in missions),
        "handovers_false": sum(mission.handovers_false for mission in missions),
        "delivered_share": sum(mission.delivered for mission in missions) / len(missions),
        "wrong": [f"seed {mission.seed}: {sentence}" for mission in missions for sentence in mission.wrong],
    }


async def _missions(samples: Samples) -> list[Mission]:
    deck = _Deck(Random(f"{samples.first_seed}/moments"))
    missions: list[Mission] = []
    killed = 0
    while killed < samples.kills:
        mission = await _mission(samples.first_seed + len(missions), deck, samples.kills - killed)
        missions.append(mission)
        killed += len(mission.killed)
        found = "".join(f"; {sentence}" for sentence in mission.wrong)
        say(f"  mission {len(missions)}: {killed} of {samples.kills} kills{found}")
        if not mission.delivered and not mission.killed:
            break  # nothing works: say so now, and not after every seed
    return missions


async def _mission(seed: int, deck: "_Deck", kills_left: int) -> Mission:
    random = Random(seed)
    moments = deck.take(min(kills_left, random.randint(*KILLS_OF_A_MISSION)), random)
    with TemporaryDirectory(prefix="kills-") as folder:
        mission = Mission(Path(folder), seed, with_charge=any(moment.name == "charging" for moment in moments))
        await mission.run(moments)
    deck.put_back(moments[len(mission.killed) :])
    return mission


class _Deck:
    """Every kind of moment comes as often as every other; what a mission had no room for comes in the next."""

    def __init__(self, random: Random) -> None:
        self._random = random
        self._cards: deque[Moment] = deque()

    def take(self, number: int, random: Random) -> list[Moment]:
        while len(self._cards) < number:
            self._cards += self._random.sample(MOMENTS, len(MOMENTS))
        taken = [self._cards.popleft() for _ in range(number)]
        return sorted(taken, key=lambda moment: random.uniform(0, 9) if moment.phase is None else moment.phase)

    def put_back(self, moments: Iterable[Moment]) -> None:
        self._cards.extendleft(moments)
