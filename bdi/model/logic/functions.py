"""Plans and rules compiled to functions of a frame or an event."""

from collections.abc import Callable, Iterable
from typing import Any, Protocol

from bdi.language.syntax import Plan, Rule
from bdi.language.terms import (
    AND,
    IN_SPACE,
    NOT,
    OR,
    TRUE,
    Atom,
    List,
    Literal,
    Predicate,
    Structure,
    Term,
    Var,
    is_internal,
)
from bdi.language.unify import Trail, undo, variables_in
from bdi.model.beliefs import Beliefs, Derivation, Relation
from bdi.model.logic.formulas import MAY_BIND, FormulaWriter
from bdi.model.logic.frames import Build, Builtin, Frame, Known, Scope, Test, deep_stack
from bdi.model.logic.proving import RUNTIME
from bdi.model.logic.writer import Flow, Writer


class PostsGoals(Protocol):
    """Whom a step that posts a goal calls, with (intention, key, arguments, annotations, plans)."""

    @property
    def achieve(self) -> Callable[..., None]: ...
    @property
    def post_goal(self) -> Callable[..., None]: ...


class Compiled:
    """A function that is compiled when it is first called, and again when what it was compiled with has changed."""

    __slots__ = ("__weakref__", "_compile", "_tell", "call")

    def __init__(self, compile_it: Callable[[Callable[[], None]], Callable[..., Any]]) -> None:
        self._compile = compile_it
        self._tell: Callable[[Callable[..., Any]], None] | None = None
        self.call: Callable[..., Any] = self._first_call

    def tell(self, tell: Callable[[Callable[..., Any]], None]) -> None:
        """Register a caller that keeps the compiled function, to save a look-up at every call."""
        self._tell = tell
        tell(self.call)

    def _first_call(self, *args: Any) -> Any:
        self._set(self._compile(self._forget))
        return self.call(*args)

    def _forget(self) -> None:
        self._set(self._first_call)

    def _set(self, call: Callable[..., Any]) -> None:
        self.call = call
        if self._tell is not None:
            self._tell(call)


class Functions(FormulaWriter):
    """Compiles against one belief base."""

    def __init__(self, beliefs: Beliefs, builtin: Callable[[Predicate], Builtin | None]) -> None:
        super().__init__(builtin)
        self.beliefs = beliefs
        self.trail: Trail = []
        self._runtime = {**RUNTIME, "trail": self.trail, "logic": self}
        self._assumed: set[Relation] = set()  # relations taken for regular by what is being compiled
        self._around: list[Var] = []
        self._asking = False  # whether a formula is being asked that may be asked again with more stack

    # ---- what writers ask for --------------------------------------------------------------------------------------

    def relation_of(self, literal: Literal) -> Relation:
        return self.beliefs.relation(literal.predicate)

    def is_regular(self, relation: Relation) -> bool:
        if relation.irregular:
            return False
        self._assumed.add(relation)
        return True

    def variables_around(self) -> list[Var]:
        return self._around

    def _made(self, w: Writer, name: str, forget: Callable[[], None]) -> Callable[..., Any]:
        for relation in self._assumed:
            relation.depend(forget)
        self._assumed.clear()
        made: Callable[..., Any] = w.made(name)
        return made

    def _writer(self, around: Iterable[Var], once: bool = True) -> Writer:
        self._assumed.clear()
        self._around = list(around)
        return Writer(self._runtime, once)

    # ---- functions of a frame --------------------------------------------------------------------------------------

    def _opened(self, w: Writer, variables: Iterable[Var], scope: Scope, known: Known, as_stored: bool = False) -> Flow:
        """The variables that have a value in the frame get names; with `as_stored` even if that is another variable."""
        flow = Flow()
        for variable in variables:
            if variable not in known.met:
                continue
            name, slot = w.fresh(variable.name), scope.slot(variable)
            w.line(f"{name} = frame[{slot}]")
            if variable not in known.filled:
                w.line(f"if {name} is None: {name} = frame[{slot}] = Var({variable.name!r})")
            if not as_stored:
                w.line(f"if type({name}) is Var: {name} = deref({name})")
            flow = flow.with_name(variable, name)
        return flow

    def _keep(self, w: Writer, before: Flow, after: Flow, scope: Scope) -> None:
        """Variables that were met on the way go into the frame."""
        for variable, name in after.names.items():
            if variable not in before.names:
                w.line(f"frame[{scope.slot(variable)}] = {name}")

    def test(self, formula: Term, scope: Scope, known: Known) -> Compiled:
        """frame → True or None: whether the formula holds; then the frame has its variables."""

        def compile_it(forget: Callable[[], None]) -> Test:
            w = self._writer(scope.slots)
            with w.function("test", "frame"):
                before = self._opened(w, self._concerned(formula), scope, known)

                def done(after: Flow) -> None:
                    self._keep(w, before, after, scope)
                    w.line("return True")

                self.formula(w, formula, before, done)
            return self._with_stack(formula, self._made(w, "test", forget))

        return Compiled(compile_it)

    def _concerned(self, formula: Term) -> Iterable[Var]:
        return list(dict.fromkeys((*variables_in(formula), *(self._around if self._names_all(formula) else ()))))

    def _names_all(self, term: Term) -> bool:
        """Return whether an internal action in it wants to know all variables by name."""
        if isinstance(term, Atom | Structure):
            if is_internal(term.predicate.name):
                builtin = self.builtin(term.predicate)
                return builtin is not None and builtin.named
            return any(self._names_all(arg) for arg in term.args)
        return False

    def rounds(self, formula: Term, scope: Scope, known: Known) -> Compiled:
        """frame → every answer as a list of (slot, value)."""
        variables = variables_in(formula)

        def compile_it(forget: Callable[[], None]) -> Callable[[Frame], list[Any]]:
            w = self._writer(scope.slots, once=False)
            with w.function("solve", "frame, found"):

                def collect(now: Flow) -> None:
                    pairs = [
                        f"({scope.slot(each)}, resolve({now.names[each]}))" for each in variables if each in now.names
                    ]
                    w.line(f"found.append([{', '.join(pairs)}])")

                self.formula(w, formula, self._opened(w, variables, scope, known), collect)
            solve = self._made(w, "solve", forget)

            def answers(frame: Frame) -> list[Any]:
                found: list[Any] = []
                solve(frame, found)
                undo(self.trail, 0)
                return found

            return self._with_stack(formula, answers)

        return Compiled(compile_it)

    def builder(self, terms: tuple[Term, ...], scope: Scope, known: Known, resolved: bool = False) -> Compiled:
        """frame → a tuple of these terms. Values may still hold variables bound later, unless `resolved`."""

        def compile_it(forget: Callable[[], None]) -> Build:
            w = self._writer(scope.slots)
            with w.function("build", "frame"):
                variables = list(dict.fromkeys(each for term in terms for each in variables_in(term)))
                before = self._opened(w, variables, scope, known)
                flow = self.met(w, variables, before)
                self._keep(w, before, flow, scope)
                parts = [(self.value if resolved else self.expression)(w, term, flow) for term in terms]
                w.line(f"return ({''.join(f'{part}, ' for part in parts)})")
            return self._made(w, "build", forget)

        return Compiled(compile_it)

    def goal_step(self, effects: PostsGoals, term: Literal, options: Any, scope: Scope, known: Known) -> Compiled:
        """(intention, means) → what posts the goal: quicker where no variable is free"""

        def call(w: Writer, flow: Flow) -> str:
            key, args = w.constant(term.predicate, "KEY"), self.expressions(w, term.args, flow)
            achieve, post = w.constant(effects.achieve, "achieve"), w.constant(effects.post_goal, "post_goal")
            fixed = " and ".join(f"type({name}) in FIXED" for name in flow.names.values())
            how = f"({post} if {fixed} else {achieve})" if fixed else post
            return f"{how}(intention, {key}, {args}, FROM_SELF, {w.constant(options, 'OPTIONS')})"

        return self._step(term, scope, known, call)

    def deed_step(self, deed: Callable[..., None], term: Literal, scope: Scope, known: Known) -> Compiled:
        """(intention, means) → deed(intention, term)"""
        return self._step(
            term, scope, known, lambda w, flow: f"{w.constant(deed, 'deed')}(intention, {self.value(w, term, flow)})"
        )

    def _step(self, term: Term, scope: Scope, known: Known, call: Callable[[Writer, Flow], str]) -> Compiled:
        def compile_it(forget: Callable[[], None]) -> Callable[..., None]:
            w = self._writer(scope.slots)
            with w.function("run", "intention, means"):
                w.line("frame = means.frame")
                variables = variables_in(term)
                before = self._opened(w, variables, scope, known, as_stored=True)
                flow = self.met(w, variables, before)
                self._keep(w, before, flow, scope)
                w.line(call(w, flow))
            return self._made(w, "run", forget)

        return Compiled(compile_it)

    def call(self, term: Literal, builtin: Builtin, scope: Scope, known: Known) -> Compiled:
        """frame → what the internal action is called with."""

        def compile_it(forget: Callable[[], None]) -> Build:
            w = self._writer(scope.slots)
            with w.function("arguments", "frame"):
                before = self._opened(w, self._concerned(term), scope, known)
                args, flow = self.arguments(w, term, builtin, before)
                self._keep(w, before, flow, scope)
                w.line(f"return {args}")
            return self._made(w, "arguments", forget)

        return Compiled(compile_it)

    def silent(self, formula: Term, scope: Scope) -> Callable[[Frame], bool]:
        """Compile a test of a formula that leaves no trace in frame or variables."""
        test = self.test(formula, scope, Known(met=frozenset(variables_in(formula))))

        def holds(frame: Frame) -> bool:
            found = test.call(frame[:]) is not None
            undo(self.trail, 0)
            return found

        return holds

    # ---- plans and rules -------------------------------------------------------------------------------------------

    def applicable(
        self, plan: Plan, scope: Scope, forget: Callable[[], None], around: tuple[Var, ...] = ()
    ) -> Callable[..., Frame | None]:
        """event → the frame of the plan if head and context hold, else None. With variables `around` a sub-plan, their
        values come with the event, as a pair."""
        w = self._writer(scope.slots)
        with w.function("applicable", "event"):
            if around:
                w.line("event, around = event")
            self._apply(w, plan, scope, lambda frame: w.line(f"return {frame}"), around)
        made = self._made(w, "applicable", forget)
        return made if plan.context is None else self._with_stack(plan.context, made)

    def choice(self, plans: Iterable[tuple[Any, Plan, Scope]], forget: Callable[[], None]) -> Callable[..., Any]:
        """event → (plan, frame) of the first plan whose head and context hold, else None."""
        w = self._writer(())
        with w.function("choose", "event"):
            for compiled, plan, scope in plans:
                self._around = list(scope.slots)
                self._attempt(w, compiled, plan, scope)
        return self._made(w, "choose", forget)

    def _attempt(self, w: Writer, compiled: Any, plan: Plan, scope: Scope) -> None:
        start = w.place

        def chosen(frame: str) -> None:
            if w.mentions(MAY_BIND, start):
                w.line("trail.clear()")
            w.line(f"return {w.constant(compiled, 'PLAN')}, {frame}")

        with w.attempt("NOT_WORKED_OUT"):  # a context that cannot be worked out does not hold
            self._apply(w, plan, scope, chosen)
        if w.mentions(MAY_BIND, start):
            w.line("if trail: undo(trail, 0)")

    def _apply(
        self, w: Writer, plan: Plan, scope: Scope, then: Callable[[str], None], around: tuple[Var, ...] = ()
    ) -> None:
        def done(now: Flow) -> None:
            then(f"[{', '.join(now.names.get(variable, 'None') for variable in scope.slots)}]")

        flow = self._matched(w, plan.head, plan.head_annots)
        if around:
            flow = self._match_all(w, around, "around", flow)
        if plan.context is None or plan.context is TRUE:
            done(flow)
        else:
            self.formula(w, plan.context, flow, done)

    def needs_rules(self, formula: Term | None) -> bool:
        """Return whether a proof by rules may be asked for."""
        return formula is not None and self._may_need_rules(formula)

    def _matched(self, w: Writer, head: Literal | Var, annots: tuple[Term, ...]) -> Flow:
        if isinstance(head, Var) or head.predicate is IN_SPACE:
            w.line("goal = event.literal")
            flow = self.match(w, head, "goal", Flow())
        else:
            flow, annots = self._match_all(w, head.args, "event.args"), head.annots
        if annots:
            flow = self.met(w, variables_in(List(annots)), flow)
            wanted = self.expressions(w, annots, flow)
            w.require(f"unify_annots(annots_of({wanted}), event.annots, trail)")
            for variable in variables_in(List(annots)):
                name = w.fresh(variable.name)
                w.line(f"{name} = deref({flow.names[variable]})")
                flow = flow.with_name(variable, name)
        return flow

    def _match_all(self, w: Writer, patterns: tuple[Term, ...], given: str, flow: Flow | None = None) -> Flow:
        flow = Flow() if flow is None else flow
        names = [w.fresh(pattern.name if isinstance(pattern, Var) else "arg") for pattern in patterns]
        if names:
            w.line(f"{', '.join(names)}, = {given}")
        for pattern, name in zip(patterns, names, strict=True):
            flow = self.match(w, pattern, name, flow)
        return flow

    def derivation(self, rule: Rule) -> Derivation:
        """A rule as an entry of its relation, compiled when it is first needed."""

        def compile_it(forget: Callable[[], None]) -> Callable[..., Any]:
            w = self._writer(variables_in(rule.formula), once=False)
            with w.function("solve", "args, then"):
                flow = self._match_all(w, rule.head.args, "args")

                def proved(now: Flow) -> None:
                    w.line("answer = then()")
                    w.line("if answer is not None: return answer")

                self.formula(w, rule.formula, flow, proved)
            return self._made(w, "solve", forget)

        return Derivation(rule, Compiled(compile_it))

    # ---- long proofs -----------------------------------------------------------------------------------------------

    def _with_stack(self, formula: Term, solve: Callable[..., Any]) -> Callable[..., Any]:
        """A proof is a chain of calls. Where rules are involved it may be longer than Python's usual limit; then the
        formula is asked again with a higher one, which holds only for that time."""
        if not self._may_need_rules(formula):
            return solve

        def ask(frame: Any) -> Any:
            if self._asking:
                return solve(frame)  # a question within a question: the outer one takes care
            mark = len(self.trail)
            self._asking = True
            try:
                return solve(frame)
            except RecursionError:
                undo(self.trail, mark)
                with deep_stack():
                    return solve(frame)
            finally:
                self._asking = False

        return ask

    def _may_need_rules(self, term: Term) -> bool:
        if not isinstance(term, Atom | Structure):
            return type(term) is Var
        key = term.predicate
        if key in (AND, OR, NOT) or is_internal(key.name):
            return any(self._may_need_rules(part) for part in term.args)
        return self.beliefs.relation(key).irregular > 0
