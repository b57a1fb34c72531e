"""Plans compiled once: head and context to one function, the body to a chain of steps.

A step is a function of the intention and the means that it belongs to; what it does to the agent goes through the
few verbs of `Doer`, which `agent` has.
"""

from collections.abc import Callable
from typing import Any, Protocol

from bdi.intentions import Event, Intention, Means, Step, StepFailed
from bdi.logic import Build, Builtin, Frame, Known, Logic, Match, Scope, Solve, succeed
from bdi.syntax import Body, Does, For, Fork, If, Plan, Simple, Trigger, While, variables_of
from bdi.syntax import Step as Written
from bdi.terms import INTERNAL, TRUE, Atom, Code, Literal, Predicate, Structure, Term, Var, show
from bdi.unify import FIXED, Trail, parts_of, renamed, resolve, resolve_all, undo, unify, unify_annots, variables_in

Applicable = Callable[[Event], "Frame | None"]  # the filled frame if head and context hold
Run = Callable[[Intention, Means], None]


class Doer(Protocol):
    """What a step of a plan can ask of the agent."""

    def start_action(self, intention: Intention, term: Literal) -> None: ...
    def call_internal(self, intention: Intention, builtin: Builtin, args: tuple[Any, ...]) -> bool: ...
    def achieve(self, intention: Intention, goal: Literal, options: "Options") -> None: ...
    def achieve_apart(self, goal: Literal, options: "Options") -> None: ...
    def ask_plans(self, intention: Intention, goal: Literal, options: "Options") -> None: ...
    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None: ...
    def forget(self, literal: Literal, intention: Intention | None) -> None: ...
    def update(self, literal: Literal, intention: Intention) -> None: ...
    def fork(self, intention: Intention, branches: list[Step | None], wait_for_all: bool) -> None: ...
    def join(self, intention: Intention) -> None: ...
    def step(self, intention: Intention) -> None: ...


class CompiledPlan:
    """A plan of one agent. Compiled when it is first considered."""

    __slots__ = ("_compiler", "applicable", "atomic", "condition", "first", "label", "plan", "subplans")

    def __init__(self, plan: Plan, compiler: "Compiler") -> None:
        self.plan = plan
        self.label = plan.label.functor
        self.atomic = plan.has("atomic")
        self.applicable: Applicable = self._compile_then_apply
        self.first: Step | None = None
        self.condition: Solve | None = None
        self.subplans = Library(compiler, plan.subplans) if plan.subplans else None
        self._compiler = compiler

    def _compile_then_apply(self, event: Event) -> Frame | None:
        self._compiler.compile(self)
        return self.applicable(event)

    def concerns(self, literal: Literal) -> bool:
        """Whether the head unifies, whatever the context says: then the plan is relevant."""
        trail: Trail = []
        found = unify(self.plan.head, renamed(literal, {}), trail)
        undo(trail, 0)
        return found


Options = list[CompiledPlan]


def relevant(options: Options, literal: Literal) -> Options:
    """Those whose head unifies with the event; if all do, the very list, which is kept up to date."""
    found = [plan for plan in options if plan.concerns(literal)]
    return options if len(found) == len(options) else found


class Library:
    """Plans by trigger and predicate, each list in source order. A list, once handed out, is kept up to date."""

    def __init__(self, compiler: "Compiler", plans: tuple[Plan, ...] = ()) -> None:
        self.compiler = compiler
        self.plans: list[CompiledPlan] = []
        self._options: dict[tuple[Trigger, Predicate], Options] = {}
        for plan in plans:
            self.add(plan)

    def options(self, trigger: Trigger, key: Predicate) -> Options:
        """The plans that could react: those with this predicate, and those whose trigger is a variable."""
        found = self._options.get((trigger, key))
        if found is None:
            found = [plan for plan in self.plans if _reacts(plan.plan, trigger, key)]
            self._options[trigger, key] = found
        return found

    def add(self, plan: Plan, first: bool = False) -> CompiledPlan:
        compiled = CompiledPlan(plan, self.compiler)
        for options in (self.plans, *self._options_with(plan)):
            options.insert(0 if first else len(options), compiled)
        return compiled

    def remove(self, label: str) -> bool:
        """Whether there was a plan with this label."""
        doomed = [plan for plan in self.plans if plan.label == label]
        for plan in doomed:
            for options in (self.plans, *self._options_with(plan.plan)):
                options.remove(plan)
        return bool(doomed)

    def _options_with(self, plan: Plan) -> list[Options]:
        return [found for (trigger, key), found in self._options.items() if _reacts(plan, trigger, key)]


def _reacts(plan: Plan, trigger: Trigger, key: Predicate) -> bool:
    return plan.trigger is trigger and (isinstance(plan.head, Var) or plan.head.predicate is key)


class Compiler:
    """Makes plans of one agent out of written ones."""

    def __init__(self, doer: Doer, logic: Logic) -> None:
        self.doer = doer
        self.logic = logic
        self.library = Library(self)

    # ---- head and context ------------------------------------------------------------------------------------------

    def compile(self, compiled: CompiledPlan) -> None:
        plan = compiled.plan
        scope, met = Scope(), set[Var]()
        head = self._head(plan, scope, met)
        known = Known().among(dict.fromkeys(met))
        context = None
        if plan.context is not None and plan.context is not TRUE:
            context = self.logic.formula(plan.context, scope, known, succeed)
            known = known.after(plan.context)
        if plan.condition is not None:
            compiled.condition = self._silent(plan.condition, scope)
        compiled.first = self.chain(plan.body, scope, known, None)
        compiled.applicable = self._applicable(plan, head, context, scope)

    def _head(self, plan: Plan, scope: Scope, met: set[Var]) -> list[Any]:
        if isinstance(plan.head, Var):
            return [self.logic.match(plan.head, scope, met)]
        return [self.logic.match(part, scope, met) for part in plan.head.args]

    def _applicable(self, plan: Plan, head: list[Any], context: Solve | None, scope: Scope) -> Applicable:
        if isinstance(plan.head, Var):
            return _applicable_any(head[0], context, [None] * scope.size)
        args = plan.head.args
        if plan.head.annots:
            return self._applicable_annotated(plan.head, head, context, scope)
        if len({arg for arg in args if type(arg) is Var}) == len(args):
            return _applicable_variables(context, [None] * (scope.size - len(args)))
        return _applicable_patterns(head, context, [None] * scope.size)

    def _applicable_annotated(
        self, pattern: Literal, head: list[Any], context: Solve | None, scope: Scope
    ) -> Applicable:
        wanted = [self.logic.build(annot, scope) for annot in pattern.annots]
        matches = _applicable_patterns(head, None, [None] * scope.size)
        trail = self.logic.trail

        def applicable(event: Event) -> Frame | None:
            frame = matches(event)
            if frame is None or not unify_annots(tuple([annot(frame) for annot in wanted]), event.annots, trail):
                return None
            return frame if context is None or context(frame) else None

        return applicable

    def _silent(self, formula: Term, scope: Scope) -> Solve:
        """Whether it holds, leaving no trace in frame or variables."""
        for variable in variables_in(formula):
            scope.slot(variable)
        solve = self.logic.compile(formula, scope, Known(met=frozenset(variables_in(formula))), succeed)
        trail = self.logic.trail

        def holds(frame: Frame) -> bool:
            found = solve(frame[:])
            undo(trail, 0)
            return found

        return holds

    # ---- bodies ----------------------------------------------------------------------------------------------------

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
            return Step(self._simple(written, scope, known), written, following)
        if isinstance(written, If):
            return self._if(written, scope, known, following)
        if isinstance(written, While):
            return self._while(written, scope, known, following)
        if isinstance(written, For):
            return self._for(written, scope, known, following)
        return self._fork(written, scope, known, following)

    def _simple(self, written: Simple, scope: Scope, known: Known) -> Run:
        term = written.term
        if written.does in (Does.CONSTRAINT, Does.TEST):
            return self._test(written, scope, known)
        if written.does is Does.INTERNAL:
            return self._internal(_literal(term), scope)
        if written.does is Does.VARIABLE or isinstance(term, Code):
            return self._variable(term, scope)
        build = self.logic.build(term, scope)
        key = term.predicate if isinstance(term, Atom | Structure) else None
        run = (
            _GOALS[written.does](self, build, key)
            if written.does in _GOALS
            else self._deed(written.does, build, _fixed(term))
        )
        return _variables_named(run, term) if isinstance(term, Var) else run

    def _deed(self, does: Does, build: Build, fixed: Literal | None) -> Run:
        doer, deed = self.doer, _DEEDS[does]
        if fixed is not None:
            return lambda intention, means: deed(doer, intention, fixed)
        return lambda intention, means: deed(doer, intention, _literal(build(means.frame)))

    def _test(self, written: Simple, scope: Scope, known: Known) -> Run:
        """?b   ?(b & X > 2)   X > 2"""
        term, trail = written.term, self.logic.trail
        solve = self.logic.formula(term, scope, known, succeed)
        build = self.logic.build(term, scope)
        error = "test_goal_failed" if written.does is Does.TEST else "constraint_failed"
        options = None
        if written.does is Does.TEST and isinstance(term, Atom | Structure):
            options = self.library.options(Trigger.TEST_ADDED, term.predicate)

        def test(intention: Intention, means: Means) -> None:
            found = solve(means.frame)
            if found:
                trail.clear()
                return
            undo(trail, 0)
            if not options:
                raise StepFailed(error, f"{written.does.value}{show(resolve(build(means.frame)))} is not the case")
            self.doer.ask_plans(intention, _literal(build(means.frame)), options)

        return test if written.does is Does.TEST else self._constraint(term, scope, test)

    def _constraint(self, term: Term, scope: Scope, test: Run) -> Run:
        """Arithmetic that cannot be done is named as such, not taken for false."""
        builds = [self.logic.build(arg, scope) for arg in getattr(term, "args", ())]

        def constraint(intention: Intention, means: Means) -> None:
            try:
                test(intention, means)
            except StepFailed:
                for build in builds:
                    resolve(build(means.frame))
                raise

        return constraint

    def _achieve(self, build: Build, key: Predicate | None) -> Run:
        """!g"""
        doer, library = self.doer, self.library
        options = library.options(Trigger.GOAL_ADDED, key) if key else None

        def achieve(intention: Intention, means: Means) -> None:
            goal = build(means.frame)
            if options is None:
                goal = resolve(goal)
                if isinstance(goal, Code):
                    return self.run_code(intention, means, goal)
                literal = _literal(goal)
                return doer.achieve(intention, literal, library.options(Trigger.GOAL_ADDED, literal.predicate))
            return doer.achieve(intention, goal, options)  # type: ignore[arg-type]

        return achieve

    def _achieve_apart(self, build: Build, key: Predicate | None) -> Run:
        """!!g"""

        def achieve_apart(intention: Intention, means: Means) -> None:
            goal = _literal(build(means.frame))
            self.doer.achieve_apart(goal, self.library.options(Trigger.GOAL_ADDED, goal.predicate))

        return achieve_apart

    def _internal(self, term: Literal, scope: Scope) -> Run:
        """.print(X)"""
        builtin = self.logic.builtin(term.predicate)
        if builtin is None:
            return _unknown_internal(term)
        arguments, doer = self.logic.arguments(term, builtin, scope), self.doer

        def internal(intention: Intention, means: Means) -> None:
            if not doer.call_internal(intention, builtin, arguments(means.frame)):
                raise StepFailed("ia_failed", f"{show(term)} failed")

        return internal

    def _variable(self, term: Term, scope: Scope) -> Run:
        """X, where X is a plan body, an action or an internal action; it starts in the same cycle."""
        build = self.logic.build(term, scope)

        def variable(intention: Intention, means: Means) -> None:
            value = resolve(build(means.frame))
            if isinstance(value, Code):
                self.run_code(intention, means, value)
            elif isinstance(value, Atom | Structure) and value.functor.startswith(INTERNAL):
                self._internal(value, Scope())(intention, means)
            elif isinstance(value, Var):
                raise StepFailed("body_var_without_value", f"{value.name} has no value")
            else:
                self.doer.start_action(intention, _literal(value))

        return variable

    def run_code(self, intention: Intention, means: Means, code: Code) -> None:
        """Go on with the body held by a value: its variables get slots at the end of the frame."""
        scope = Scope(len(means.frame))
        for variable, value in code.scope.items():
            scope.slot(variable)
            means.frame.append(value)
        means.step = self.chain(code.body, scope, Known().among(code.scope), means.step)
        means.frame.extend([None] * (scope.size - len(means.frame)))
        if means.step is not None:
            self.doer.step(intention)

    # ---- control ---------------------------------------------------------------------------------------------------

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


# ---- helpers of the compiler ---------------------------------------------------------------------------------------


def _applicable_variables(context: Solve | None, empty: Frame) -> Applicable:
    """A head of different variables takes the arguments as they are."""
    if context is None:
        return lambda event: [*event.args, *empty]

    def applicable(event: Event) -> Frame | None:
        frame = [*event.args, *empty]
        return frame if context(frame) else None

    return applicable


def _applicable_patterns(head: list[Match], context: Solve | None, empty: Frame) -> Applicable:
    def applicable(event: Event) -> Frame | None:
        frame = empty[:]
        for match, arg in zip(head, event.args, strict=True):
            if not match(frame, arg):
                return None
        return frame if context is None or context(frame) else None

    return applicable


def _applicable_any(match: Match, context: Solve | None, empty: Frame) -> Applicable:
    """+!G: the variable is the whole event."""

    def applicable(event: Event) -> Frame | None:
        frame = empty[:]
        if not match(frame, event.literal):
            return None
        return frame if context is None or context(frame) else None

    return applicable


def _known_after(written: Written, known: Known) -> Known:
    """A finished step has filled its variables, except where it may have skipped them."""
    if isinstance(written, Simple) and written.does is Does.INTERNAL:
        return Known(known.filled, known.met | frozenset(variables_in(written.term)))
    if isinstance(written, Simple):
        return known.after(written.term)
    return Known(known.filled, known.met | frozenset(variables_of(Body((written,)))))


def _fixed(term: Term) -> Literal | None:
    """The literal itself if every part is a plain value, so that there is nothing to work out."""
    plain = isinstance(term, Atom | Structure) and all(type(part) in FIXED for part in parts_of(term))
    return term if plain else None  # type: ignore[return-value]


def _literal(value: Term) -> Literal:
    """A value about to be done or believed; anything else fails by name."""
    if type(value) is Structure:
        return Structure(value[0], resolve_all(value[1]), resolve_all(value[2]))
    if type(value) is Atom:
        return value
    resolved = resolve(value) if type(value) not in FIXED else value
    if isinstance(resolved, Atom | Structure):
        return resolved
    raise StepFailed("wrong_arguments", f"{show(resolved)} is no literal")


def _variables_named(run: Run, variable: Var) -> Run:
    def named(intention: Intention, means: Means) -> None:
        try:
            run(intention, means)
        except StepFailed as failure:
            if failure.error == "wrong_arguments":
                raise StepFailed("body_var_without_value", f"{variable.name} has no value") from failure
            raise

    return named


def _unknown_internal(term: Literal) -> Run:
    def unknown(intention: Intention, means: Means) -> None:
        raise StepFailed("unknown_internal_action", f"there is no internal action {term.functor}/{len(term.args)}")

    return unknown


_GOALS: dict[Does, Callable[[Compiler, Build, Predicate | None], Run]] = {
    Does.ACHIEVE: Compiler._achieve,
    Does.ACHIEVE_APART: Compiler._achieve_apart,
}
_DEEDS: dict[Does, Callable[[Doer, Intention, Literal], None]] = {
    Does.ACTION: lambda doer, intention, term: doer.start_action(intention, term),
    Does.ADD: lambda doer, intention, term: doer.believe(term, intention),
    Does.ADD_FIRST: lambda doer, intention, term: doer.believe(term, intention),
    Does.ADD_LAST: lambda doer, intention, term: doer.believe(term, intention, last=True),
    Does.ADD_APART: lambda doer, intention, term: doer.believe(term, None),
    Does.REMOVE: lambda doer, intention, term: doer.forget(term, intention),
    Does.REMOVE_APART: lambda doer, intention, term: doer.forget(term, None),
    Does.UPDATE: lambda doer, intention, term: doer.update(term, intention),
}
