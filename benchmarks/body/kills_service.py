"""The service that a killed robot comes back to. It keeps every word, grants what is claimed, and finds what is wrong.

It judges by what it was told alone: numbers without gaps, no number used twice, no report told twice under another
number, no corridor given back that was never granted, no hand-over whose code was never shown.
"""

import asyncio
from collections import Counter
from collections.abc import Hashable
from dataclasses import dataclass, field
from random import Random

from benchmarks.body.played_server import PlayedServer
from protocol.both_ways import Ack
from protocol.envelope import Envelope
from protocol.parts import Leg, Part, Purpose
from protocol.sequence import Reception, reception, resume
from protocol.to_robot import Grant
from protocol.to_server import Charge, Claim, Clear, Event, Fault, HandoverReceipt, Hello, Progress, Step

BREAKS_OF_MESSAGES = 0.05
"""The share of durable messages with which the network breaks: sent, and never heard."""
THINKS_S = 0.03
"""The longest a claim waits for its answer: long enough that a robot can be killed in between."""


@dataclass
class Service(PlayedServer):
    """`said` and `told` are the two journals: message `n` of ours is `said[n - 1]`, of the robot's `told[n]`."""

    random: Random = field(default_factory=Random)
    said: list[Part] = field(default_factory=list)
    told: dict[int, Part] = field(default_factory=dict)
    taken: int = 0
    """Up to which number of ours the robot has acknowledged."""
    hellos: list[Hello] = field(default_factory=list)
    lent: dict[Leg, int] = field(default_factory=dict)
    """Corridors that are granted and not reported clear, each with the number of the grant."""
    shown: set[tuple[str, Purpose]] = field(default_factory=set)
    """The codes that people have held up."""
    broken: bool = False
    breaks: int = 0
    wrong: list[str] = field(default_factory=list)

    async def say(self, *messages: Part) -> None:
        """Durable: sent now if the robot listens, and at every greeting until it is acknowledged."""
        self.said += messages
        await self._send_from(len(self.said) - len(messages) + 1)

    async def _send_from(self, first: int) -> None:
        for number in range(first, len(self.said) + 1):
            if self.sockets:
                await self.send(self.said[number - 1], number, self.received.seq)

    async def hear(self, envelope: Envelope) -> None:
        if await self._is_lost(envelope):
            return
        self.taken = max(self.taken, envelope.ack)
        match envelope.body:
            case Hello() as hello:
                resumption = resume(self.received, envelope.journal, hello.resume_from)
                if resumption.lost:
                    self.wrong.append(f"{resumption.lost} messages can never come again")
                self.received = resumption.received
                await super().hear(envelope)
                self.hellos.append(hello)
                await self._send_from(hello.received.seq + 1)
            case _:
                await super().hear(envelope)
                if envelope.seq is not None:
                    await self._take(envelope, envelope.seq)

    async def _is_lost(self, envelope: Envelope) -> bool:
        """Return whether the network breaks with this message, or has broken before it."""
        if isinstance(envelope.body, Hello):
            self.broken = False
        elif not self.broken and envelope.seq is not None and self.random.random() < BREAKS_OF_MESSAGES:
            self.broken, self.breaks = True, self.breaks + 1
            await self.sockets[-1].close()
        return self.broken

    async def _take(self, envelope: Envelope, number: int) -> None:
        match reception(self.received, envelope.journal, number):
            case Reception.GAP:
                self.wrong.append(f"number {number} came after {self.received.seq}")
                return
            case Reception.REPEATED:
                if self.told[number] != envelope.body:
                    self.wrong.append(
                        f"number {number} came again as {envelope.body}, before it was {self.told[number]}"
                    )
            case Reception.NEW:
                self.told[number] = envelope.body
                self.received = self.received.model_copy(update={"seq": number})
        await self.send(Ack(), ack=number)
        if isinstance(envelope.body, Claim):
            await asyncio.sleep(self.random.uniform(0, THINKS_S))
            await self._grant(envelope.body)
        elif isinstance(envelope.body, Clear):
            self._take_back(envelope.body.leg)

    async def _grant(self, claim: Claim) -> None:
        held = [leg for leg in claim.legs if self.lent.get(leg, self.taken + 1) <= self.taken]
        if held:
            self.wrong.append(f"it claims {_legs(held)}, which it was granted and has acknowledged")
        new = tuple(leg for leg in claim.legs if leg not in self.lent)
        if new:
            self.lent |= dict.fromkeys(new, len(self.said) + 1)
            await self.say(Grant(claim_id=claim.claim_id, legs=new))

    def _take_back(self, leg: Leg) -> None:
        if self.lent.pop(leg, None) is None:
            self.wrong.append(f"it is clear of {_legs([leg])}, which it does not hold")


def _legs(legs: list[Leg]) -> str:
    return ", ".join(f"{leg.from_post} → {leg.to_post}" for leg in legs)


def handovers(told: dict[int, Part]) -> list[HandoverReceipt]:
    events = (told[number] for number in sorted(told))
    return [
        event.happened for event in events if isinstance(event, Event) and isinstance(event.happened, HandoverReceipt)
    ]


def told_twice(told: dict[int, Part]) -> list[str]:
    """The reports that came again under another number."""
    keys = Counter(key for key in map(_once, told.values()) if key)
    again = [f"told {count} times: {key}" for key, count in keys.items() if count > 1]
    return again + _repeated_in_a_row([told[number] for number in sorted(told)])


def _once(message: Part) -> Hashable:
    """Return the key of a message that may be told but once, ever."""
    happened = message.happened if isinstance(message, Event) else None
    match happened:
        case Progress(step=Step.PASSED):
            return happened.mission_id, happened.step, happened.stop_id, happened.post
        case Progress():
            return happened.mission_id, happened.step, happened.stop_id
        case HandoverReceipt():
            return happened.order_id, happened.purpose
    return None


def _repeated_in_a_row(messages: list[Part]) -> list[str]:
    """A charge goes from step to step, a fault begins and is over: the same twice running was told twice."""
    key: str
    state: str
    again, last = [], dict[str, str]()
    for message in messages:
        happened = message.happened if isinstance(message, Event) else None
        match happened:
            case Charge():
                key, state = "charge", happened.step
            case Fault():
                key, state = f"fault {happened.name}", "over" if happened.cleared else "begun"
            case _:
                continue
        if last.get(key) == state:
            again.append(f"told twice running: {key} {state}")
        last[key] = state
    return again
