"""Terms as Python expressions: one that makes the term, or lines that match a value against it."""

from collections.abc import Callable, Iterable
from typing import Any

from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.terms import ANNOTATED, Atom, Code, Literal, OpenList, Predicate, Structure, Term, Var, predicate
from bdi.language.unify import EVALUATED, FIXED, parts_of, resolve, variables_in
from bdi.model.logic.frames import Builtin
from bdi.model.logic.writer import Flow, Writer

EXACT = {predicate("+", 2): "+", predicate("-", 2): "-", predicate("*", 2): "*"}
DIV = predicate("div", 2)
WHOLE_BOUND = 2**53  # as in `terms.number`


class TermWriter:
    """Writes terms."""

    def __init__(self, builtin: Callable[[Predicate], Builtin | None]) -> None:
        self.builtin = builtin

    # ---- making ----------------------------------------------------------------------------------------------------

    def met(self, w: Writer, variables: Iterable[Var], flow: Flow) -> Flow:
        """Every variable gets a name; one that has not been met becomes a free variable."""
        for variable in variables:
            if variable not in flow.names:
                name = w.fresh(variable.name)
                w.line(f"{name} = Var({variable.name!r})")
                flow = flow.with_name(variable, name)
        return flow

    def expression(self, w: Writer, term: Term, flow: Flow) -> str:
        """A Python expression that makes the term. All its variables have names."""
        if type(term) is int and abs(term) < WHOLE_BOUND:
            return repr(term)
        if type(term) in FIXED and not self.has_functions(term):
            return w.constant(term)
        if type(term) is Var:
            return flow.names[term]
        if type(term) is Code:
            scope = ", ".join(
                f"{w.constant(each)}: {self.expression(w, value, flow)}" for each, value in term.scope.items()
            )
            return f"Code({w.constant(term.body, 'BODY')}, {{{scope}}})"
        if not variables_in(term) and not self.has_functions(term):
            return self._ground(w, term)
        if isinstance(term, Atom | Structure):
            return self._structure(w, term, flow)
        if isinstance(term, OpenList):
            items, tail = self.expressions(w, term.items, flow), self.expression(w, term.tail, flow)
            return f"resolve(OpenList({items}, {tail}))"
        return f"List({self.expressions(w, parts_of(term), flow)})"

    def expressions(self, w: Writer, terms: Iterable[Term], flow: Flow) -> str:
        """A Python tuple of them."""
        return "(" + "".join(f"{self.expression(w, term, flow)}, " for term in terms) + ")"

    def value(self, w: Writer, term: Term, flow: Flow) -> str:
        """Write the term like `expression`, with variables replaced by their values."""
        if self._is_flat(term):
            args = "".join(f"{self.value(w, arg, flow)}, " for arg in term.args)  # type: ignore[union-attr]
            return f"make(Structure, ({w.constant(term.predicate, 'KEY')}, ({args}), ()))"  # type: ignore[union-attr]
        made = self.expression(w, term, flow)
        if (
            type(term) in FIXED
            or (type(term) is Var and term in flow.plain)
            or (made.isidentifier() and type(term) is not Var)
        ):
            return made
        return f"({made} if type({made}) in FIXED else resolve({made}))" if type(term) is Var else f"resolve({made})"

    def _is_flat(self, term: Term) -> bool:
        """p(X,a): nothing but variables and values without parts, so that it is enough to look at each."""
        if type(term) is not Structure or term.annots or not variables_in(term) or term.predicate in EVALUATED:
            return False
        return all(map(is_simple, term.args)) and not self.has_functions(term)

    def _ground(self, w: Writer, term: Term) -> str:
        try:
            return self.expression_of_value(w, resolve(term))
        except ArithmeticFailure:
            return f"resolve({w.constant(term)})"

    def expression_of_value(self, w: Writer, value: Term) -> str:
        return repr(value) if type(value) is int and abs(value) < WHOLE_BOUND else w.constant(value)

    def _structure(self, w: Writer, term: Literal, flow: Flow) -> str:
        key = term.predicate
        if key in EXACT:
            return self._exact(w, term, flow)
        args = self.expressions(w, term.args, flow)
        if key in EVALUATED and not self.function(key):
            return f"calculated({w.constant(key, 'OPERATOR')}, {args})"
        function = self.function(key)
        if function:
            return f"{w.constant(function, 'FUNCTION')}(resolve_all({args}))"
        if key is ANNOTATED:
            return f"annotated(resolve({args}[0]), resolve_all({self.expressions(w, term.annots, flow)}))"
        annots = f"annots_of({self.expressions(w, term.annots, flow)})" if term.annots else "()"
        return f"make(Structure, ({w.constant(key, 'KEY')}, {args}, {annots}))"

    def _exact(self, w: Writer, term: Literal, flow: Flow) -> str:
        """+ - * of whole numbers right here, anything else by `calculated`."""
        names, tests = [], []
        for arg in term.args:
            made = self.expression(w, arg, flow)
            if type(arg) is int:
                names.append(made)
                continue
            name = made if made.isidentifier() else w.fresh("n")
            tests.append(f"(type({made if name == made else f'{name} := {made}'}) is int)")
            names.append(name)
        left, right = names
        total, key = w.fresh("n"), w.constant(term.predicate, "OPERATOR")
        result = f"({total} := {left} {EXACT[term.predicate]} {right})"
        step = _step_of(term)
        fits = f"{-WHOLE_BOUND} <= {result} <= {WHOLE_BOUND}"
        if step:
            fits = f"{result} <= {WHOLE_BOUND}" if step > 0 else f"{result} >= {-WHOLE_BOUND}"
        whole = f"({total} if {fits} else float({total}))"
        return f"({whole} if {' & '.join(tests)} else calculated({key}, ({left}, {right})))"

    def has_functions(self, term: Term) -> bool:
        if isinstance(term, Atom | Structure) and self.function(term.predicate):
            return True
        return any(self.has_functions(part) for part in parts_of(term))

    def function(self, key: Predicate) -> Any:
        """The arithmetic function of this name, such as `math.abs`, if there is one."""
        return getattr(self.builtin(key), "function", None)

    def may_fail(self, term: Term) -> bool:
        """Return whether making it can raise ArithmeticFailure."""
        if isinstance(term, Atom | Structure) and (term.predicate is DIV or self.function(term.predicate)):
            return True
        return any(self.may_fail(part) for part in parts_of(term))

    # ---- matching --------------------------------------------------------------------------------------------------

    def match(self, w: Writer, pattern: Term, given: str, flow: Flow) -> Flow:
        """Go on only if the value in `given` unifies with the pattern."""
        if type(pattern) is Var:
            if pattern not in flow.names:
                return flow.with_name(pattern, given)
            w.require(f"unify({flow.names[pattern]}, {given}, trail)")
            return flow
        if type(pattern) in FIXED:
            wanted = self.expression(w, pattern, flow)
            w.refuse(f"{given} != {wanted} and (type({given}) in FIXED or not unify({wanted}, {given}, trail))")
            return flow
        flow = self.met(w, variables_in(pattern), flow)
        w.require(f"unify({self.expression(w, pattern, flow)}, {given}, trail)")
        return flow


def _step_of(term: Literal) -> int:
    """X + 1 is 1, X - 2 is -2: then only one bound can be passed. Otherwise 0."""
    by = term.args[1]
    if type(by) is not int or term.predicate.name not in "+-":
        return 0
    return by if term.predicate.name == "+" else -by


def is_simple(term: Term) -> bool:
    """A variable or a value without parts."""
    return type(term) is Var or type(term) in FIXED
