"""The corridors that the robot may enter: what it asks for, takes back, is granted, and gives back."""

from collections.abc import Callable, Iterable, Sequence

from protocol.ids import new_uuid
from protocol.parts import Leg
from protocol.to_robot import Deny, Detour, Grant
from protocol.to_server import Claim, Clear, Withdraw
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.state import Held
from robot.mission.store import Store


class Claims:
    """One claim at a time. `alone`: without a server the robot grants itself everything."""

    def __init__(
        self,
        store: Store,
        memory: Memory,
        outbox: Outbox,
        held: Callable[[], Held],
        told: Callable[[], None],
        alone: bool,
    ) -> None:
        self._store, self._memory, self._outbox = store, memory, outbox
        self._held, self._told = held, told
        self.alone = alone
        self._wanted: tuple[Leg, ...] = ()
        self._goal: str | None = None
        self._claim_id: str | None = None
        self._waits = False
        self._denied: dict[str, Deny] = {}
        self.avoid: frozenset[Leg] = frozenset()
        """What was denied last, until it is granted."""

    def may_enter(self, legs: Sequence[Leg]) -> bool:
        return self.alone or all(leg in self._held().grants for leg in legs)

    def may_leave(self, post: str, but_to: str | None) -> bool:
        """Return whether it was granted a way on from this post, other than back where it comes from. Any thread may
        ask."""
        return self.alone or any(leg.from_post == post and leg.to_post != but_to for leg in self._held().grants)

    def may_be_in(self, leg: Leg) -> bool:
        """No other robot is let into a corridor that it was granted, whichever way it goes in there."""
        return self.alone or any(
            {leg.from_post, leg.to_post} == {one.from_post, one.to_post} for one in self._held().grants
        )

    def ask(self, legs: Sequence[Leg], goal: str | None = None) -> str | None:
        """Claim those of `legs` that are not granted yet, once for each goal; returns the claim's id, or None if none
        is needed."""
        wanted = tuple(leg for leg in dict.fromkeys(legs) if leg not in self._held().grants)
        if self.alone or not wanted:
            return None
        if not self._waits or (wanted, goal) != (self._wanted, self._goal):
            self._wanted, self._goal, self._claim_id, self._waits = wanted, goal, new_uuid(), True
            self._outbox.put(Claim(claim_id=self._claim_id, legs=wanted, goal=goal))
            self._denied.clear()  # of older claims, which no action waits for any more
            self._told()
        return self._claim_id

    def withdraw(self) -> None:
        """It wants no longer what it waits for. What was granted before the service reads this is given back when it
        comes (`hear`)."""
        if self._waits and self._claim_id is not None:
            self._outbox.put(Withdraw(claim_id=self._claim_id))
            self._forget()
            self._told()

    def denial(self, claim_id: str) -> Deny | None:
        """The service's refusal of a claim, taken once: the next claim is a new one."""
        denied = self._denied.pop(claim_id, None)
        if denied:
            self._forget()
        return denied

    def hear(self, answer: Grant | Detour | Deny) -> None:
        """Apply the service's answer. Memory holds what was granted already."""
        is_asked_for = answer.claim_id == self._claim_id
        if is_asked_for:
            self._waits = False
        if isinstance(answer, Deny):
            self._denied[answer.claim_id] = answer
            self.avoid = frozenset(answer.avoid)
            return
        self.avoid -= frozenset(answer.legs)
        # On its way it may be in one of them, and while it waits for another way one may be of use: the next claim or
        # the next rest gives them back then.
        if not is_asked_for and not self._waits and self._memory.position().towards is None:
            self._give_back(answer.legs, self._memory.grants())

    def clear(self, legs: Iterable[Leg]) -> None:
        """The robot is out of these corridors, or will not enter them after all. What it waits for it still wants."""
        if self._give_back(legs, self._held().grants):
            self._told()

    def turn_aside(self, leg: Leg) -> None:
        """It takes this corridor, which it holds, instead of the one that it waits for."""
        self.withdraw()
        self._memory.turn_aside(leg)
        self._told()

    def void(self) -> None:
        """Drop all grants and denials."""
        self._forget()
        self.avoid = frozenset()

    def _give_back(self, legs: Iterable[Leg], grants: Sequence[Leg]) -> bool:
        """Return whether any of them was held."""
        granted = [leg for leg in legs if leg in grants]
        with self._store.transaction():
            for leg in granted:
                self._memory.clear(leg)
                self._outbox.put(Clear(leg=leg, post=self._memory.position().post))
        return bool(granted)

    def _forget(self) -> None:
        self._wanted, self._goal, self._claim_id, self._waits = (), None, None, False
