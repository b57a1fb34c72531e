"""One mission whose robot is killed again and again: people with codes, and the judgement after every kill."""

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from random import Random

from benchmarks.body.kills_judge import Facts, judged_disk, judged_hello
from benchmarks.body.kills_moments import Moment
from benchmarks.body.kills_robot import Robot, remembered
from benchmarks.body.kills_service import Service, handovers, told_twice
from benchmarks.body.played_server import playing
from protocol import to_robot
from protocol.parts import Purpose, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import Verifier, Verifiers
from protocol.to_server import Charge, Claim, Event, HandoverReceipt, Progress, Step

SPEED = 40.0
"""Asked of the clock; the daemon slows it down to what the machine can do."""
LOW_RATIO = 0.2
LOOK_REAL_S = 0.002
SHOWN_FOR_S = 5.0
GREETS_WITHIN_REAL_S = 30.0
MOMENT_WITHIN_REAL_S = 120.0
DELIVERS_WITHIN_REAL_S = 180.0
POSTS = ("post1", "post2", "post3", "post4")
ORDER = "o1"
STOP_OF = {Purpose.LOAD: "s1", Purpose.RECEIVE: "s2"}


class Stuck(Exception):
    """Something that had to happen did not."""


class Mission:
    """A letter from post to post. Of the `moments` to kill at, `killed` are those that came."""

    def __init__(self, folder: Path, seed: int, with_charge: bool) -> None:
        random = self._random = Random(seed)
        self.seed = seed
        self._folder, self._low = folder, with_charge
        from_post, to_post = random.sample(POSTS, 2)
        self._codes = {purpose: f"CM1:{random.randbytes(16).hex()}" for purpose in STOP_OF}
        self._mission = to_robot.Mission(
            id=f"m{seed}",
            update=1,
            stops=(
                Stop(
                    id=STOP_OF[Purpose.LOAD], post=from_post, action=StopAction.LOAD, order_id=ORDER, wait_limit_s=1e6
                ),
                Stop(
                    id=STOP_OF[Purpose.RECEIVE],
                    post=to_post,
                    action=StopAction.RECEIVE,
                    order_id=ORDER,
                    wait_limit_s=1e6,
                ),
            ),
        )
        self.service = Service(random=random)
        self.killed: list[Moment] = []
        self.knew = 0
        self.wrong: list[str] = []
        self.delivered = False
        self._begin_again()

    def _begin_again(self) -> None:
        """Reset the counts since the last start of the daemon."""
        self._heard_before = len(self.service.heard)
        self._shown_now: set[Purpose] = set()
        self._greeted = False

    async def run(self, moments: Sequence[Moment]) -> None:
        async with playing(server=self.service):
            self.robot = Robot(self._folder, self.service.url, self.seed, SPEED)
            people = asyncio.create_task(self._people())
            try:
                await self._play(moments)
            except Stuck as stuck:
                self.wrong.append(f"{stuck}; it is at {self._last_progress()}; log: {self.robot.log()}")
            finally:
                people.cancel()
                with suppress(asyncio.CancelledError):
                    await people
                await self.robot.kill()
        self._judge_end()

    async def _play(self, moments: Sequence[Moment]) -> None:
        await self.service.say(self._verifiers(), self._mission)
        await self._start(None)
        for moment in moments:
            if not await self._comes(moment):
                break
            facts = await self._kill(moment)
            await self._start(facts)
        await self._until("it delivers", lambda: self._is_over, DELIVERS_WITHIN_REAL_S)
        await self.robot.kill()
        self.wrong += judged_disk(self._facts())

    def _verifiers(self) -> Verifiers:
        expires_at = self.robot.clock.utc().replace(year=2999)
        return Verifiers(
            verifiers=tuple(
                Verifier(order_id=ORDER, purpose=purpose, sha256=ShownCode.of(code).sha256, expires_at=expires_at)
                for purpose, code in self._codes.items()
            )
        )

    # Kill and start ----------------------------------------------------------------------------------------------

    async def _comes(self, moment: Moment) -> bool:
        """Wait for the moment; False if the mission ends before it."""
        self.has_written()
        await self._until(moment.name, lambda: moment.begins(self) or self._is_over, MOMENT_WITHIN_REAL_S)
        if self._is_over:
            return False
        await asyncio.sleep(self.robot.clock.real_s(self._random.uniform(0, moment.within_s)))
        return not self._is_over

    async def _kill(self, moment: Moment) -> Facts:
        await self.robot.kill()
        self.killed.append(moment)
        facts = self._facts()
        found = judged_disk(facts)
        self.knew += not found
        self.wrong += [f"killed {moment.name} (kill {len(self.killed)}): {sentence}" for sentence in found]
        return facts

    def _facts(self) -> Facts:
        return Facts(self.service, self._mission, remembered(self.robot.data))

    async def _start(self, facts: Facts | None) -> None:
        """Show no code before the daemon has said what it knows: it must be what was on the disk."""
        self._begin_again()
        greetings = len(self.service.hellos)
        await self.robot.start()
        await self._until("its hello", lambda: len(self.service.hellos) > greetings, GREETS_WITHIN_REAL_S)
        if facts:
            found = judged_hello(facts, self.service.hellos[-1])
            if found:
                self.knew -= 1
            self.wrong += [f"started again (kill {len(self.killed)}): {sentence}" for sentence in found]
        self._greeted = True

    async def _until(self, what: str, wanted: Callable[[], bool], limit_s: float) -> None:
        loop = asyncio.get_running_loop()
        until_s = loop.time() + limit_s
        while not wanted():
            if self.robot.ended is not None:
                raise Stuck(f"waiting for: {what}: the daemon ended with {self.robot.ended}")
            if loop.time() > until_s:
                raise Stuck(f"waited in vain for: {what}")
            await asyncio.sleep(LOOK_REAL_S)

    # What a moment asks ------------------------------------------------------------------------------------------

    @property
    def has_mail(self) -> bool:
        return len(handovers(self.service.told)) == 1

    @property
    def charges(self) -> bool:
        events = [event.happened for event in self._events()]
        steps = [happened.step for happened in events if isinstance(happened, Charge)]
        return steps[-1:] == ["charging"]

    @property
    def has_claimed(self) -> bool:
        return any(isinstance(envelope.body, Claim) for envelope in self.service.heard[self._heard_before :])

    def is_shown(self, purpose: Purpose) -> bool:
        return purpose in self._shown_now

    def has_written(self) -> bool:
        before, self._written = getattr(self, "_written", None), self.robot.written()
        return before is not None and before != self._written and self._random.random() < 0.3

    # People ------------------------------------------------------------------------------------------------------

    async def _people(self) -> None:
        while True:
            if self._greeted:
                await self._act()
            await asyncio.sleep(self.robot.clock.real_s(1.0))

    async def _act(self) -> None:
        purpose = self._waited_for()
        if purpose:
            self.service.shown.add((ORDER, purpose))  # before: it may be told before the door has answered
            if await self.robot.world(do="show_code", text=self._codes[purpose], for_s=SHOWN_FOR_S):
                self._shown_now.add(purpose)
        if self._low and self.has_mail and await self.robot.world(do="battery", ratio=LOW_RATIO):
            self._low = False

    def _waited_for(self) -> Purpose | None:
        """The code of the stop at which the robot has told that it arrived."""
        done = {receipt.purpose for receipt in handovers(self.service.told)}
        for purpose, stop in STOP_OF.items():
            if purpose not in done:
                return purpose if self._has_told(Step.ARRIVED, stop) else None
        return None

    def _events(self) -> list[Event]:
        told = self.service.told
        return [message for message in map(told.get, sorted(told)) if isinstance(message, Event)]

    def _has_told(self, step: Step, stop: str | None = None) -> bool:
        happened = (event.happened for event in self._events())
        return any(isinstance(one, Progress) and one.step is step and one.stop_id == stop for one in happened)

    def _last_progress(self) -> str:
        return str([event.happened for event in self._events()][-1:])

    @property
    def _is_over(self) -> bool:
        return self._has_told(Step.DONE)

    # The end -----------------------------------------------------------------------------------------------------

    def _judge_end(self) -> None:
        self.told_twice = told_twice(self.service.told)
        receipts = handovers(self.service.told)
        self.delivered = self._is_over and [receipt.purpose for receipt in receipts] == list(STOP_OF)
        self.handovers_lost = max(0, len(STOP_OF) - len(receipts)) if self._is_over else 0
        self.handovers_false = sum(not self._is_true(receipt) for receipt in receipts)
        self.wrong += self.service.wrong + self.told_twice

    def _is_true(self, receipt: HandoverReceipt) -> bool:
        shown = (receipt.order_id, receipt.purpose) in self.service.shown
        code = ShownCode.of(self._codes[receipt.purpose])
        return shown and (receipt.code_sha256, receipt.proof) == (code.sha256, receipt.proved_with(code.key))
