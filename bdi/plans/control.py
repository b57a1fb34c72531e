"""How steps follow each other: bodies, `if`, `while`, `for`, branches side by side."""

from collections.abc import Callable
from typing import Any

from bdi.intentions import Intention, Means, Step
from bdi.logic import Frame, Known, Scope, succeed
from bdi.plans.steps import Steps
from bdi.syntax import Body, Does, For, Fork, If, Simple, While, variables_of
from bdi.syntax import Step as Written
from bdi.terms import Term
from bdi.unify import resolve, variables_in


class Control(Steps):
    """Compiles bodies to linked steps."""

    def chain(self, body: Body, scope: Scope, known: Known, following: Step | None) -> Step | None:
        """The steps of a body, linked; after the last comes `following`."""
        before: list[Known] = []
        for written in body.steps:
            before.append(known)
            known = _known_after(written, known)
        for written, now in zip(reversed(body.steps), reversed(before), strict=True):
            following = self._step(written, scope, now, following)
        return following

    def _step(self, written: Written, scope: Scope, known: Known, following: Step | None) -> Step:
        if isinstance(written, Simple):
            return Step(self.simple(written, scope, known), written, following)
        if isinstance(written, If):
            return self._if(written, scope, known, following)
        if isinstance(written, While):
            return self._while(written, scope, known, following)
        if isinstance(written, For):
            return self._for(written, scope, known, following)
        return self._fork(written, scope, known, following)

    def _if(self, written: If, scope: Scope, known: Known, following: Step | None) -> Step:
        """if (c) {..} else {..}"""
        condition = self.logic.formula(written.condition, scope, known, succeed)
        met = Known(known.filled, known.met | frozenset(variables_in(written.condition)))
        then = self.chain(written.then, scope, known.after(written.condition), following)
        otherwise = self.chain(written.otherwise, scope, met, following)
        trail = self.logic.trail

        def branch(intention: Intention, means: Means) -> None:
            holds = condition(means.frame)
            trail.clear()
            means.step = then if holds else otherwise

        return Step(branch, written, following)

    def _while(self, written: While, scope: Scope, known: Known, following: Step | None) -> Step:
        """while (c) {..}: what a round binds is forgotten before the next."""
        condition = self.logic.formula(written.condition, scope, known, succeed)
        trail = self.logic.trail

        def loop(intention: Intention, means: Means) -> None:
            if not means.loops or means.loops[-1][0] is not step:
                means.loops.append((step, means.frame[:]))
            means.frame[:] = means.loops[-1][1]
            holds = condition(means.frame)
            trail.clear()
            if holds:
                means.step = first
            else:
                means.loops.pop()
                means.step = following

        step = Step(loop, written, following)
        first = self.chain(written.body, scope, known.after(written.condition), step)
        return step

    def _for(self, written: For, scope: Scope, known: Known, following: Step | None) -> Step:
        """for (c) {..}: all answers are found first, then the body runs once for each."""
        answers = self._answers(written.condition, scope, known)

        def loop(intention: Intention, means: Means) -> None:
            if not means.loops or means.loops[-1][0] is not step:
                means.loops.append((step, means.frame[:], answers(means.frame)))
            _, saved, left = means.loops[-1]
            means.frame[:] = saved
            answer = next(left, None)
            if answer is None:
                means.loops.pop()
                means.step = following
                return
            for slot, value in answer:
                means.frame[slot] = value
            means.step = first

        step = Step(loop, written, following)
        first = self.chain(written.body, scope, known.after(written.condition), step)
        return step

    def _answers(self, formula: Term, scope: Scope, known: Known) -> Callable[[Frame], Any]:
        variables = variables_in(formula)
        slots = [scope.slot(variable) for variable in variables]
        found: list[list[tuple[int, Term]]] = []

        def collect(frame: Frame) -> bool:
            values = [(slot, frame[slot]) for slot in slots]
            found.append([(slot, resolve(value)) for slot, value in values if value is not None])
            return False

        solve = self.logic.formula(formula, scope, known, collect)

        def answers(frame: Frame) -> Any:
            found.clear()
            solve(frame)
            return iter(found[:])

        return answers

    def _fork(self, written: Fork, scope: Scope, known: Known, following: Step | None) -> Step:
        """a |&| b   a ||| b"""
        doer = self.doer
        join = Step(lambda intention, means: doer.join(intention), written, following)
        firsts = [self.chain(branch, scope, known, join) for branch in written.branches]
        return Step(
            lambda intention, means: doer.fork(intention, firsts, written.wait_for_all),
            written,
            following,
        )


def _known_after(written: Written, known: Known) -> Known:
    """A finished step has filled its variables, except where it may have skipped them."""
    if isinstance(written, Simple) and written.does is Does.INTERNAL:
        return Known(known.filled, known.met | frozenset(variables_in(written.term)))
    if isinstance(written, Simple):
        return known.after(written.term)
    return Known(known.filled, known.met | frozenset(variables_of(Body((written,)))))
