"""A running action: polled by the mind until it ends, cancelled when its intention is dropped."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from robot.skills.interfaces import Body, Done, JobEnd, Skill


@dataclass(frozen=True)
class Ended:
    """`failure` is None for success, else an atom that says why not."""

    failure: str | None = None


DONE = Ended()
Ends = Mapping[int, JobEnd]


class Run(Protocol):
    """An action under way. A cancelled one is polled until it has ended, too."""

    def poll(self, ends: Ends, now: float) -> Ended | None:
        """None while it goes on. `ends` are the skills that have ended since the last look, by job."""
        ...

    def cancel(self) -> None:
        """Its intention was dropped: stop what it has begun."""
        ...


class AtOnce:
    """Had ended when it began."""

    def __init__(self, ended: Ended = DONE) -> None:
        self._ended = ended

    def poll(self, ends: Ends, now: float) -> Ended:
        return self._ended

    def cancel(self) -> None:
        pass


class Rest:
    """Nothing, until a time."""

    def __init__(self, until_s: float) -> None:
        self._until_s = until_s

    def poll(self, ends: Ends, now: float) -> Ended | None:
        return DONE if now >= self._until_s else None

    def cancel(self) -> None:
        self._until_s = -math.inf


class Wait:
    """Until a question has an answer; `dropped` is called if the answer is no longer wanted."""

    def __init__(self, ask: Callable[[], Ended | None], dropped: Callable[[], None] = lambda: None) -> None:
        self._ask, self._dropped = ask, dropped

    def poll(self, ends: Ends, now: float) -> Ended | None:
        return self._ask()

    def cancel(self) -> None:
        self._ask = lambda: DONE
        self._dropped()


SkillMaker = Callable[[], Skill | None]
"""Makes the skill when its turn comes; None: there is nothing to do."""


class Skills:
    """One skill after another; the first that fails ends the action. `then` hears what the last one gave.

    `rescue` names failures and what to try after one of them, once: if that succeeds, so did the skill before it.
    """

    def __init__(
        self,
        body: Body,
        makers: Sequence[SkillMaker],
        now: float,
        then: Callable[[Done], None] | None = None,
        rescue: Mapping[str, SkillMaker] | None = None,
    ) -> None:
        self._body, self._waiting, self._then, self._rescue = body, list(makers), then, dict(rescue or {})
        self._job: int | None = None
        self._last = Done()
        self._begin_next(now)

    def _begin_next(self, now: float) -> None:
        self._job = None
        while self._waiting and self._job is None:
            skill = self._waiting.pop(0)()
            self._job = self._body.start(skill, now) if skill else None

    def poll(self, ends: Ends, now: float) -> Ended | None:
        end = ends.get(self._job) if self._job is not None else None
        if end is not None:
            if isinstance(end.outcome, Done):
                self._last = end.outcome
            elif end.outcome.reason in self._rescue:
                self._waiting.insert(0, self._rescue.pop(end.outcome.reason))
            else:
                return Ended(end.outcome.reason)
            self._begin_next(now)
        if self._job is not None:
            return None
        if self._then:
            self._then(self._last)
        return DONE

    def cancel(self) -> None:
        self._waiting, self._rescue = [], {}
        if self._job is not None:
            self._body.cancel(self._job)


class Unless:
    """A run that ends early, and well, as soon as something else has happened."""

    def __init__(self, run: Run, happened: Callable[[], bool], then: Callable[[], None]) -> None:
        self._run, self._happened, self._then = run, happened, then

    def poll(self, ends: Ends, now: float) -> Ended | None:
        if self._happened():
            self.cancel()
            self._then()
            return DONE
        return self._run.poll(ends, now)

    def cancel(self) -> None:
        self._run.cancel()


class Meanwhile:
    """A run beside which something is done in every tick."""

    def __init__(self, run: Run, again: Callable[[], None]) -> None:
        self._run, self._again = run, again

    def poll(self, ends: Ends, now: float) -> Ended | None:
        self._again()
        return self._run.poll(ends, now)

    def cancel(self) -> None:
        self._run.cancel()


class ThenRest:
    """A run whose success is told only after a rest. `over` hears of any end."""

    def __init__(self, run: Run, rest_s: float, over: Callable[[], None]) -> None:
        self._run, self._rest_s, self._over = run, rest_s, over
        self._rest: Rest | None = None

    def poll(self, ends: Ends, now: float) -> Ended | None:
        ended = self._rest.poll(ends, now) if self._rest else self._run.poll(ends, now)
        if ended == DONE and self._rest is None:
            self._rest = Rest(now + self._rest_s)
            return None
        if ended:
            self._over()
        return ended

    def cancel(self) -> None:
        self._over()
        self._run.cancel()
        self._rest_s = -math.inf
        if self._rest:
            self._rest.cancel()
