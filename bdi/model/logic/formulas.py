"""Formulas as Python source: the one place where generated code comes from.

A formula is written as lines that go on where it is true and fail where it is not: `continue` with the next answer of
the innermost loop, or `return None`. What comes after is written by `then(flow)`, so a conjunction is one text after
another, and a second answer is the next round of a loop. A function answers something else than None as soon as its
last line is reached. For example `line(D) & not postPoint(_)` becomes

    for D, in reversed(line.facts):
        if postPoint.facts: continue
        return [D]

Nothing here takes bindings back on the way out: a loop does so at the start of each round, a caller at the end.
"""

from abc import abstractmethod
from collections.abc import Callable
from typing import TypeAlias

from bdi.language.terms import (
    AND,
    ANNOTATED,
    IN_SPACE,
    NOT,
    OR,
    RELATIONS,
    Atom,
    Literal,
    Structure,
    Term,
    Var,
    is_internal,
)
from bdi.language.unify import FIXED, variables_in
from bdi.model.logic.conditions import Conditions
from bdi.model.logic.frames import Builtin
from bdi.model.logic.terms import is_simple
from bdi.model.logic.writer import DEEPEST_LOOPS, Flow, Writer

Then: TypeAlias = Callable[[Flow], None]
MAY_CHANGE = ("each(", "then", "rest", "side", "ask(", "collect(")  # calls that can do anything, also to beliefs
MAY_BIND = ("trail", "space(", *MAY_CHANGE)  # calls that can leave bindings behind


class FormulaWriter(Conditions):
    """Writes formulas."""

    def formula(self, w: Writer, term: Term, flow: Flow, then: Then) -> None:
        if isinstance(term, Structure) and term.predicate is AND:  # one line after another, not one condition
            left, right = term.args
            self.formula(w, left, flow, lambda after: self.formula(w, right, after, then))
            return
        condition = self.condition(w, term, flow)
        if condition is not None:
            if condition != "True":
                w.require(condition)
            then(flow)
        elif not isinstance(term, Atom | Structure):
            self._unknown_yet(w, term, flow, then)
        elif w.loops >= DEEPEST_LOOPS:
            self._apart(w, term, flow, then)
        else:
            self._literal_or_operator(w, term, flow, then)

    def _literal_or_operator(self, w: Writer, term: Literal, flow: Flow, then: Then) -> None:
        key = term.predicate
        if key is OR:
            self._either(w, term, flow, then)
        elif key is NOT:
            self._not(w, term.args[0], flow, then)
        elif key in RELATIONS:
            self._comparison(w, term, flow, then)
        elif key is ANNOTATED:
            self._unknown_yet(w, term, flow, then)
        elif key is IN_SPACE:
            self._in_space(w, term, flow, then)
        elif is_internal(key.name):
            self._internal(w, term, flow, then)
        else:
            self._literal(w, term, flow, then)

    def _apart(self, w: Writer, term: Term, flow: Flow, then: Then) -> None:
        """Write a function of its own, since Python limits loops within each other."""
        name = w.fresh("rest")
        with w.function(name):
            self.formula(w, term, flow, then)
        self._hand_on(w, f"{name}()")

    def _hand_on(self, w: Writer, call: str) -> None:
        """Return the result of the call, if it has one."""
        answer = w.fresh("answer")
        w.line(f"{answer} = {call}")
        w.line(f"if {answer} is not None: return {answer}")

    # ---- literals ----------------------------------------------------------------------------------------------------

    def _literal(self, w: Writer, term: Literal, flow: Flow, then: Then) -> None:
        relation = self.relation_of(term)
        name = w.constant(relation, term.functor)
        if not self.is_regular(relation):
            found = self._found(w, term, flow, then)
            flow = self.met(w, variables_in(term), flow)
            rest = self._continuation(w, flow, found)
            args, annots = self._wanted(w, term, flow)
            self._hand_on(w, f"prove({name}, {args}, {annots}, trail, {rest})")
            return
        free = [arg for arg in term.args if type(arg) is Var and arg not in flow.names]
        if term.annots or not all(map(is_simple, term.args)) or len(set(free)) < len(free):
            found = self._found(w, term, flow, then)
            flow = self.met(w, variables_in(term), flow)
            args, annots = self._wanted(w, term, flow)
            self._rounds(w, "_", "", f"unified({name}, {args}, {annots}, trail)", "", found, flow)
        elif not free:
            self._look_up(w, term, name, flow, then)
        else:
            self._scan(w, term, name, flow, then)

    def _found(self, w: Writer, term: Literal, before: Flow, then: Then) -> Then:
        """Variables that were bound are replaced by what they stand for."""
        new = [variable for variable in variables_in(term) if variable not in before.names]

        def found(flow: Flow) -> None:
            for variable in new:
                name = w.fresh(variable.name)
                w.line(f"{name} = deref({flow.names[variable]})")
                flow = flow.with_name(variable, name)
            then(flow)

        return found

    def _in_space(self, w: Writer, term: Literal, flow: Flow, then: Then) -> None:
        """NS::p(X), n::X: in each namespace in which there is such a belief."""
        found = self._found(w, term, flow, then)
        flow = self.met(w, variables_in(term), flow)
        self._rounds(w, "_", "", f"logic.bound_in_any_space({self.value(w, term, flow)})", "", found, flow)

    def _wanted(self, w: Writer, term: Literal, flow: Flow) -> tuple[str, str]:
        annots = f"annots_of({self.expressions(w, term.annots, flow)})" if term.annots else "()"
        return self.expressions(w, term.args, flow), annots

    def _look_up(self, w: Writer, term: Literal, name: str, flow: Flow, then: Then) -> None:
        """Every variable has its value, but perhaps one with variables in it."""
        args = self.expressions(w, term.args, flow)
        fixed = self._fixed(term, flow)
        quick = f"(ONCE if {args} in {name}.facts else ())"
        self._rounds(w, "_", quick, f"unified({name}, {args}, (), trail)", fixed, then, flow)

    def _scan(self, w: Writer, term: Literal, name: str, flow: Flow, then: Then) -> None:
        """Write a loop in which some variables get their value: `dockStation(D)`."""
        wanted, checks, parts, after = [], [], [], flow
        for arg in term.args:
            if type(arg) is Var and arg not in flow.names:
                local = w.fresh(arg.name)
                after = after.with_name(arg, local, plain=True)
                wanted.append("Var()")
            else:
                local = w.fresh("arg")
                given = self.expression(w, arg, flow)
                unsure = "" if flow.is_plain(arg) else f" and type({given}) in FIXED"
                checks.append(f"{local} != {given}{unsure}")
                wanted.append(given)
            parts.append(local)
        source = f"reversed({name}.facts)"
        first = term.args[0]
        if not (type(first) is Var and first not in flow.names):
            source = f"{name}.candidates({wanted[0]})"
        slow = f"unified({name}, ({', '.join(wanted)},), (), trail)"

        def filtered(now: Flow) -> None:
            for check in checks:
                w.refuse(check)
            then(now)

        self._rounds(w, ", ".join(parts) + ",", source, slow, self._fixed(term, flow), filtered, after)

    def _fixed(self, term: Literal, flow: Flow) -> str:
        """The test that equality will do for all arguments; nothing if that is sure."""
        unsure = [
            flow.names[arg] for arg in term.args if type(arg) is Var and arg in flow.names and arg not in flow.plain
        ]
        return " and ".join(f"type({name}) in FIXED" for name in dict.fromkeys(unsure))

    def _rounds(self, w: Writer, target: str, quick: str, slow: str, fixed: str, then: Then, flow: Flow) -> None:
        """A loop over the answers of `quick` (if `fixed`), else of `slow`, which takes back its bindings itself."""
        mark, before, depth = w.fresh("mark"), w.place, w.depth
        with w.loop("for"):
            inside = w.place
            then(flow)
        if target != "_" and w.mentions(MAY_CHANGE, inside):
            quick = f"tuple({quick})"
        if w.mentions(MAY_BIND, inside):
            if quick and not fixed:
                w.insert(inside, f"if len(trail) > {mark}: undo(trail, {mark})", depth + 1)
                w.insert(before, f"{mark} = len(trail)", depth)
                before += 1
            elif quick:
                quick = f"restoring({quick}, trail)"
        if quick and fixed:
            w.replace(before, f"for {target} in ({quick} if {fixed} else {slow}):", depth)
        else:
            w.replace(before, f"for {target} in {quick or slow}:", depth)

    def _continuation(self, w: Writer, flow: Flow, then: Then) -> str:
        """Write the continuation as a function of its own."""
        name = w.fresh("then")
        with w.function(name):
            then(flow)
        return name

    # ---- operators ---------------------------------------------------------------------------------------------------

    def _either(self, w: Writer, term: Literal, flow: Flow, then: Then) -> None:
        """The same continuation after the left and after the right side."""
        new = [variable for variable in variables_in(term) if variable not in flow.names]
        names = [w.fresh(variable.name) for variable in new]
        after = flow
        for variable, name in zip(new, names, strict=True):
            after = after.with_name(variable, name)
        rest, mark = w.fresh("then"), w.fresh("mark")
        with w.function(rest, ", ".join(names)):
            then(after)
        w.line(f"{mark} = len(trail)")

        def go_on(now: Flow) -> None:
            now = self.met(w, new, now)
            self._hand_on(w, f"{rest}({', '.join(now.names[variable] for variable in new)})")

        for side in term.args:
            branch = w.fresh("side")
            with w.function(branch):
                self.formula(w, side, flow, go_on)
            self._hand_on(w, f"{branch}()")
            w.line(f"undo(trail, {mark})")

    def _not(self, w: Writer, term: Term, flow: Flow, then: Then) -> None:
        name, mark, found = w.fresh("found"), w.fresh("mark"), w.fresh("is_so")
        with w.function(name):
            self.formula(w, term, flow, lambda now: w.line("return True"))
        w.line(f"{mark} = len(trail)")
        w.line(f"{found} = {name}()")
        w.line(f"undo(trail, {mark})")
        w.refuse(found)
        then(flow)

    def _comparison(self, w: Writer, term: Literal, flow: Flow, then: Then) -> None:
        """X = f(Y)   X =.. [name,args,annots]   X < Y with what must be calculated first"""
        left, right = term.args
        name = term.predicate.name
        if name == "=":
            for variable, value in ((left, right), (right, left)):
                if type(variable) is Var and variable not in flow.names and variable not in variables_in(value):
                    self._assign(w, variable, value, flow, then)
                    return
        flow = self.met(w, variables_in(term), flow)
        a, b = self.value(w, left, flow), self.value(w, right, flow)
        tests = {"=": f"unify({a}, {b}, trail)", "=..": f"decomposed({a}, {b}, trail)"}
        with w.block("try:"):
            w.require(tests.get(name) or f"holds({name!r}, {a}, {b})")
        w.line(f"except ArithmeticFailure: {w.fail()}")
        then(flow)

    def _assign(self, w: Writer, variable: Var, value: Term, flow: Flow, then: Then) -> None:
        """X = t for a variable that has not been met."""
        flow = self.met(w, variables_in(value), flow)
        name, made = w.fresh(variable.name), self.value(w, value, flow)
        if type(value) not in FIXED:
            with w.block("try:"):
                w.line(f"{name} = {made}")
            w.line(f"except ArithmeticFailure: {w.fail()}")
        else:
            w.line(f"{name} = {made}")
        then(
            flow.with_name(variable, name, plain=type(value) in FIXED or (flow.is_plain(value) and type(value) is Var))
        )

    def _unknown_yet(self, w: Writer, term: Term, flow: Flow, then: Then) -> None:
        """A formula that is only known when it is asked: compiled then."""
        flow = self.met(w, variables_in(term), flow)
        rest = self._continuation(w, flow, then)
        self._hand_on(w, f"ask({self.value(w, term, flow)}, {rest})")

    # ---- internal actions --------------------------------------------------------------------------------------------

    def _internal(self, w: Writer, term: Literal, flow: Flow, then: Then) -> None:
        builtin = self.builtin(term.predicate)
        if builtin is None:
            w.line(w.fail())
            return
        args, flow = self.arguments(w, term, builtin, flow)
        ask = w.constant(builtin.ask, "internal")
        self._rounds(w, "_", "", f"each({ask}({args}), trail)", "", then, flow)

    def arguments(self, w: Writer, term: Literal, builtin: Builtin, flow: Flow) -> tuple[str, Flow]:
        """Write the arguments of an internal action: values, and questions where it asks for them."""
        lazy = [arg for place, arg in enumerate(term.args) if place in builtin.lazy]
        eager = [arg for place, arg in enumerate(term.args) if place not in builtin.lazy]
        for arg in eager:
            flow = self.met(w, variables_in(arg), flow)
        if builtin.named:
            flow = self.met(w, self.variables_around(), flow)
        concerned = list(dict.fromkeys(variable for arg in lazy for variable in variables_in(arg)))
        parts = [
            self._question(w, arg, concerned, flow) if place in builtin.lazy else self.value(w, arg, flow)
            for place, arg in enumerate(term.args)
        ]
        if builtin.named:
            parts.insert(0, "{" + ", ".join(f"{v.name!r}: {name}" for v, name in flow.names.items()) + "}")
        return "(" + "".join(f"{part}, " for part in parts) + ")", flow

    @abstractmethod
    def variables_around(self) -> list[Var]:
        """Return all variables of the plan that is being compiled."""

    def _question(self, w: Writer, term: Term, concerned: list[Var], flow: Flow) -> str:
        """solve(known values…, collect), build(all values…), now(known values…)"""
        known = [variable for variable in concerned if variable in flow.names]
        inner = Flow({variable: flow.names[variable] for variable in known}, flow.plain)
        values = ", ".join(f"{flow.names[variable]}" for variable in known)
        parameters = f"{values}, collect" if values else "collect"
        solve, build, now = w.fresh("solve"), w.fresh("build"), w.fresh("now")

        def collect(after: Flow) -> None:
            after = self.met(w, concerned, after)
            self._hand_on(w, f"collect({', '.join(after.names[variable] for variable in concerned)})")

        once, w.once = w.once, False
        with w.function(solve, parameters):
            self.formula(w, term, inner, collect)
        w.once = once
        everything = Flow({variable: w.fresh(variable.name) for variable in concerned})
        with w.function(build, ", ".join(everything.names.values())):
            w.line(f"return {self.expression(w, term, everything)}")
        with w.function(now, values):
            w.line(f"return {self.expression(w, term, self.met(w, variables_in(term), inner))}")
        return f"Question({solve}, {build}, {now}, ({values}{',' if values else ''}), logic)"
