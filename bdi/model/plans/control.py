"""Control flow: bodies, `if`, `while`, `for`, parallel branches."""

from bdi.language.syntax import Body, Does, For, Fork, If, Simple, While, variables_of
from bdi.language.syntax import Step as Written
from bdi.language.terms import Atom, Structure, Term, Var
from bdi.language.unify import undo, variables_in
from bdi.model.intentions import Intention, Means, Step
from bdi.model.logic import Compiled, Known, Scope
from bdi.model.plans.steps import Run, Steps
from bdi.model.plans.written_out import as_statement


class Control(Steps):
    """Compiles bodies to linked steps."""

    def chain(self, body: Body, scope: Scope, known: Known, following: Step | None) -> Step | None:
        """The steps of a body, linked; after the last comes `following`."""
        before: list[Known] = []
        for written in body.steps:
            before.append(known)
            known = self._known_after(written, known, scope)
        for written, now in zip(reversed(body.steps), reversed(before), strict=True):
            following = self._step(written, scope, now, following)
        return following

    def _known_after(self, written: Written, known: Known, scope: Scope) -> Known:
        """A finished step has filled its variables, except where it may have skipped them."""
        if isinstance(written, Simple) and written.does is Does.INTERNAL:
            return Known(known.filled, known.met | self._met_by(written.term, scope))
        if isinstance(written, Simple):
            return known.after(written.term)
        return Known(known.filled, known.met | frozenset(variables_of(Body((written,)))))

    def _met_by(self, term: Term, scope: Scope) -> frozenset[Var]:
        """An action that takes the variables by name may fill any of them: .wait("+b(X)")"""
        builtin = self.logic.builtin(term.predicate) if isinstance(term, Atom | Structure) else None
        return frozenset(scope.slots if builtin is not None and builtin.named else variables_in(term))

    def _step(self, written: Written, scope: Scope, known: Known, following: Step | None) -> Step:
        if isinstance(written, Simple):
            other = as_statement(written)
            if other is not None:
                return self._step(other, scope, known, following)
            return _step_of(self.simple(written, scope, known), written, following)
        if isinstance(written, If):
            return self._if(written, scope, known, following)
        if isinstance(written, While):
            return self._while(written, scope, known, following)
        if isinstance(written, For):
            return self._for(written, scope, known, following)
        return self._fork(written, scope, known, following)

    def _if(self, written: If, scope: Scope, known: Known, following: Step | None) -> Step:
        """if (c) {..} else {..}"""
        condition = self.logic.test(written.condition, scope, known)
        met = Known(known.filled, known.met | frozenset(variables_in(written.condition)))
        then = self.chain(written.then, scope, known.after(written.condition), following)
        otherwise = self.chain(written.otherwise, scope, met, following)
        trail = self.logic.trail

        def branch(intention: Intention, means: Means) -> None:
            holds = condition.call(means.frame)
            trail.clear() if holds else undo(trail, 0)
            means.step = then if holds else otherwise

        return Step(branch, written, following)

    def _while(self, written: While, scope: Scope, known: Known, following: Step | None) -> Step:
        """while (c) {..}: what a round binds is forgotten before the next."""
        condition = self.logic.test(written.condition, scope, known)
        trail = self.logic.trail

        def loop(intention: Intention, means: Means) -> None:
            if not means.loops or means.loops[-1][0] is not step:
                means.loops = (*means.loops, (step, means.frame[:]))
            means.frame[:] = means.loops[-1][1]
            holds = condition.call(means.frame)
            trail.clear() if holds else undo(trail, 0)
            if holds:
                means.step = first
            else:
                means.loops = means.loops[:-1]
                means.step = following

        step = Step(loop, written, following)
        first = self.chain(written.body, scope, known.after(written.condition), step)
        return step

    def _for(self, written: For, scope: Scope, known: Known, following: Step | None) -> Step:
        """for (c) {..}: all answers are found first, then the body runs once for each."""
        answers = self.logic.rounds(written.condition, scope, known)

        def loop(intention: Intention, means: Means) -> None:
            if not means.loops or means.loops[-1][0] is not step:
                means.loops = (*means.loops, (step, means.frame[:], iter(answers.call(means.frame))))
            _, saved, left = means.loops[-1]
            means.frame[:] = saved
            answer = next(left, None)
            if answer is None:
                means.loops = means.loops[:-1]
                means.step = following
                return
            for slot, value in answer:
                means.frame[slot] = value
            means.step = first

        step = Step(loop, written, following)
        first = self.chain(written.body, scope, known.after(written.condition), step)
        return step

    def _fork(self, written: Fork, scope: Scope, known: Known, following: Step | None) -> Step:
        """a |&| b   a ||| b"""
        effects = self.effects
        join = Step(lambda intention, means: effects.join(intention), written, following)
        meanwhile = Known(known.filled, known.met | frozenset(variables_of(Body((written,)))))  # by another branch
        firsts = [self.chain(branch, scope, meanwhile, join) for branch in written.branches]
        return Step(
            lambda intention, means: effects.fork(intention, firsts, written.wait_for_all),
            written,
            following,
        )


def _step_of(run: Run | Compiled, written: Written, following: Step | None) -> Step:
    if not isinstance(run, Compiled):
        return Step(run, written, following)
    step = Step(run.call, written, following)
    run.tell(step.runs)
    return step
