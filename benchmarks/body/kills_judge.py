"""Judge a killed daemon: what it must know by what both sides said, compared with its disk and with its hello."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from benchmarks.body.kills_robot import Remembered
from benchmarks.body.kills_service import Service, handovers
from protocol.parts import MissionHeld, Part, Purpose
from protocol.to_robot import Grant, Mission
from protocol.to_server import Clear, Event, Hello, Progress, Step


@dataclass(frozen=True)
class Facts:
    """Both sides at the moment of a kill."""

    service: Service
    mission: Mission
    disk: Remembered

    @property
    def told(self) -> dict[int, Part]:
        """Return everything that the robot ever told, and what it has yet to tell."""
        return self.disk.pending | self.service.told

    @property
    def said(self) -> list[Part]:
        """Return the service's messages that are on the robot's disk."""
        return self.service.said[: self.disk.received.seq]


def judged_disk(facts: Facts) -> list[str]:
    """Return what is wrong with the disk, in sentences."""
    return [*_journal(facts), *_mission(facts), *_cargo(facts), *_grants(facts)]


def judged_hello(facts: Facts, hello: Hello) -> list[str]:
    """Return what is wrong with what the restarted daemon says, beside what was on its disk."""
    disk = facts.disk
    all_done = disk.mission is not None and disk.mission.next_stop == len(facts.mission.stops)
    pairs = {
        "cargo": (hello.cargo, disk.cargo),
        "mission": (hello.mission, hello.mission if all_done and hello.mission is None else disk.mission),
        "last post": (hello.position.post, hello.position.post if disk.position.post is None else disk.position.post),
        "received": (hello.received, disk.received),
        "resume_from": (hello.resume_from, disk.resume_from),
    }
    return [f"hello: {name} is {said}, on the disk {kept}" for name, (said, kept) in pairs.items() if said != kept]


def _journal(facts: Facts) -> Iterator[str]:
    disk, service = facts.disk, facts.service
    if disk.received.seq < service.taken:
        yield f"it acknowledged {service.taken} and has {disk.received.seq} on its disk"
    if service.told and disk.last_seq < max(service.told):
        yield f"it told number {max(service.told)} and would number on from {disk.last_seq}"
    lost = sorted(set(range(1, disk.last_seq + 1)) - facts.told.keys())
    if lost:
        yield f"reports are lost: {lost}"
    changed = [number for number, message in disk.pending.items() if service.told.get(number, message) != message]
    if changed:
        yield f"other reports under numbers that were told: {changed}"


def _mission(facts: Facts) -> Iterator[str]:
    events = [message.happened for message in facts.told.values() if isinstance(message, Event)]
    is_done = any(isinstance(happened, Progress) and happened.step is Step.DONE for happened in events)
    wanted = None
    if facts.mission in facts.said and not is_done:
        next_stop = len(handovers(facts.told))
        wanted = MissionHeld(id=facts.mission.id, update=facts.mission.update, next_stop=next_stop)
    if facts.disk.mission != wanted:
        yield f"mission is {facts.disk.mission}, must be {wanted}"


def _cargo(facts: Facts) -> Iterator[str]:
    cargo: tuple[str, ...] = ()
    for receipt in handovers(facts.told):
        rest = tuple(one for one in cargo if one != receipt.order_id)
        cargo = (*rest, receipt.order_id) if receipt.purpose is Purpose.LOAD else rest
    if facts.disk.cargo != cargo:
        yield f"cargo is {facts.disk.cargo}, must be {cargo}"


def _grants(facts: Facts) -> Iterator[str]:
    """The service grants no corridor again before it was reported clear: what is left over is held."""
    granted = Counter(leg for message in facts.said if isinstance(message, Grant) for leg in message.legs)
    granted.subtract(message.leg for message in facts.told.values() if isinstance(message, Clear))
    wanted, held = {leg for leg, count in granted.items() if count}, set(facts.disk.grants)
    if held != wanted:
        yield f"grants are {sorted(map(str, held))}, must be {sorted(map(str, wanted))}"
