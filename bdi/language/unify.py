"""Making two terms equal, undoing it, and reading off what came out.

A variable is bound by setting its `ref`; every binding is written on the trail, so that undoing means walking back.
Annotations are a subset test: `p(X)[a]` unifies with `p(1)[a,b]`, not the other way round.
"""

from collections.abc import Callable, Iterable
from functools import cmp_to_key
from typing import Any

from bdi.language.arithmetic import ArithmeticFailure, calculate
from bdi.language.terms import (
    ANNOTATED,
    ARITHMETIC,
    IN_SPACE,
    NEGATIVE,
    POSITIVE,
    PRIVATE_SPACE,
    Atom,
    Code,
    Handle,
    List,
    Literal,
    OpenList,
    String,
    Structure,
    Term,
    Var,
    annotated,
    in_space,
    literal_of,
    number,
    plain,
    show,
    space_of,
)

Trail = list[Var]
EVALUATED = ARITHMETIC | {NEGATIVE, POSITIVE, IN_SPACE}  # what resolving a term works out
FIXED = frozenset({Atom, int, float, String, Handle})  # types without parts and without variables


def deref(term: Term) -> Term:
    """Return the value of a variable; any other term is itself."""
    while type(term) is Var:
        if term.ref is None:
            return term
        term = term.ref
    return term


def undo(trail: Trail, mark: int) -> None:
    """Take back every binding made since the trail was `mark` long."""
    while len(trail) > mark:
        trail.pop().ref = None


def bind(variable: Var, value: Term, trail: Trail) -> bool:
    variable.ref = value
    trail.append(variable)
    return True


def unify(left: Term, right: Term, trail: Trail) -> bool:
    """Bind variables so that both are equal. On failure some may stay bound: the caller undoes to its mark."""
    left, right = deref(left), deref(right)
    if left is right:
        return True
    if type(left) is Var:
        return bind(left, right, trail)
    if type(right) is Var:
        return bind(right, left, trail)
    unifier = _UNIFIERS.get(type(left))
    return unifier(left, right, trail) if unifier else left == right


def unify_all(left: Iterable[Term], right: Iterable[Term], trail: Trail) -> bool:
    """Unify two sequences of the same length."""
    return all(unify(a, b, trail) for a, b in zip(left, right, strict=True))


def _unify_atom(left: Atom, right: Term, trail: Trail) -> bool:
    # An atom is also part of the same atom with annotations.
    if type(right) is not Structure:
        return False
    return left.predicate is right.predicate or _unify_in_space(left, right, trail)


def _unify_in_space(left: Literal, right: Literal, trail: Trail) -> bool:
    """`NS::p(X)`, `n::X` or `X[a]` with a literal. A variable never learns the name of a local namespace."""
    if right.predicate in (IN_SPACE, ANNOTATED):
        left, right = right, left
    if left.predicate is ANNOTATED:
        return unify(left.args[0], right, trail) and unify_annots(left.annots, right.annots, trail)
    key = right.predicate
    if left.predicate is not IN_SPACE or key is IN_SPACE:
        return False
    space = deref(left.args[0])
    if type(space) is Var and key.namespace.startswith(PRIVATE_SPACE):
        return False
    inner = literal_of(plain(key), right.args, right.annots)
    return unify(space, space_of(key), trail) and unify(left.args[1], inner, trail)


def _unify_structure(left: Structure, right: Term, trail: Trail) -> bool:
    key, args, annots = left
    if type(right) is Structure:
        if key is not right.predicate:
            return _unify_in_space(left, right, trail)
        return unify_all(args, right.args, trail) and (not annots or unify_annots(annots, right.annots, trail))
    if type(right) is Atom:
        if key is not right.predicate:
            return _unify_in_space(left, right, trail)
        return not annots or unify_annots(annots, (), trail)
    return key in ARITHMETIC and type(right) in (int, float) and _amounts_to(left, right)


def _amounts_to(expression: Structure, value: Term) -> bool:
    try:
        return resolve(expression) == value
    except ArithmeticFailure:
        return False


def unify_annots(wanted: tuple[Term, ...], present: tuple[Term, ...], trail: Trail) -> bool:
    """Unify each wanted annotation with a present one. A last `|T` takes the present ones that were not asked for.

    Both sides are gone through once, in standard order, so that two wanted annotations never share a present one.
    """
    tail = None
    last = wanted[-1]
    if present and type(present[-1]) is OpenList and type(last) is not OpenList:
        wanted, present, last = present, wanted, present[-1]
    if type(last) is OpenList:
        wanted, tail = (*wanted[:-1], *last.items), last.tail
    left_over = sorted(present, key=in_order)
    start = 0
    for annot in sorted(wanted, key=in_order) if len(wanted) > 1 else wanted:
        place = _place_of(annot, left_over, start, trail)
        if place is None:
            return False
        del left_over[place]
        start = place
    return tail is None or unify(tail, List(left_over), trail)


def _place_of(annot: Term, present: list[Term], start: int, trail: Trail) -> int | None:
    for place in range(start, len(present)):
        mark = len(trail)
        if unify(annot, present[place], trail):
            return place
        undo(trail, mark)
    return None


def _unify_list(left: List, right: Term, trail: Trail) -> bool:
    if type(right) is List:
        return len(left) == len(right) and unify_all(left, right, trail)
    return type(right) is OpenList and _unify_open_list(right, left, trail)


def _unify_open_list(left: OpenList, right: Term, trail: Trail) -> bool:
    count = len(left.items)
    if type(right) is List:
        return (
            len(right) >= count
            and unify_all(left.items, right[:count], trail)
            and unify(left.tail, List(right[count:]), trail)
        )
    if type(right) is not OpenList:
        return False
    if len(right.items) < count:
        return _unify_open_list(right, left, trail)
    rest: Term = OpenList(right.items[count:], right.tail) if right.items[count:] else right.tail
    return unify_all(left.items, right.items[:count], trail) and unify(left.tail, rest, trail)


_UNIFIERS: dict[type, Callable[..., bool]] = {
    Atom: _unify_atom,
    Structure: _unify_structure,
    List: _unify_list,
    OpenList: _unify_open_list,
}


def unify_by(kind: type, unifier: Callable[[Any, Term, Trail], bool]) -> None:
    """Register the unification of a kind of value that is defined in a higher module."""
    _UNIFIERS[kind] = unifier


# ---- reading off ---------------------------------------------------------------------------------------------------


def resolve(term: Term) -> Term:
    """The term with every bound variable replaced by its value and arithmetic worked out where it can be."""
    if type(term) in FIXED:
        return term
    return _RESOLVERS[type(term)](term)


def resolve_all(terms: tuple[Term, ...]) -> tuple[Term, ...]:
    return tuple([term if type(term) in FIXED else _RESOLVERS[type(term)](term) for term in terms])


def _resolve_var(term: Var) -> Term:
    value = deref(term)
    return value if type(value) is Var else resolve(value)


def _resolve_structure(term: Structure) -> Term:
    key, args, annots = term
    args = resolve_all(args)
    if key in EVALUATED:
        return evaluated(Structure(key, args))
    if key is ANNOTATED:
        return annotated(args[0], annots_of(annots))
    return Structure(key, args, annots_of(annots) if annots else annots)


def evaluated(expression: Structure) -> Term:
    """The number, or the expression itself while an operand is not yet a number. Raises ArithmeticFailure."""
    key, args, _ = expression
    if key is IN_SPACE:
        return in_space(*args)
    if not all(type(arg) in (int, float) for arg in args):
        return expression
    if key is NEGATIVE:
        return number(-args[0])  # type: ignore[operator]
    if key is POSITIVE:
        return args[0]
    return calculate(key, args[0], args[1])  # type: ignore[arg-type]


def annots_of(annots: tuple[Term, ...]) -> tuple[Term, ...]:
    """Annotations with their values; a tail that became a list is spliced in."""
    flat: list[Term] = []
    for annot in annots:
        value = resolve(annot)
        flat.extend(value if type(value) is List else [value])
    return tuple(flat)


def _resolve_list(term: List) -> List:
    return List(resolve_all(term))


def _resolve_open_list(term: OpenList) -> Term:
    items = resolve_all(term.items)
    tail = resolve(term.tail)
    if type(tail) is List:
        return List((*items, *tail))
    if type(tail) is OpenList:
        return OpenList((*items, *tail.items), tail.tail)
    return OpenList(items, tail)


def _resolve_code(term: Code) -> Code:
    return Code(term.body, {variable: resolve(value) for variable, value in term.scope.items()})


_RESOLVERS: dict[type, Callable[..., Term]] = {
    Var: _resolve_var,
    Structure: _resolve_structure,
    List: _resolve_list,
    OpenList: _resolve_open_list,
    Code: _resolve_code,
}


def variables_in(term: Term, found: dict[Var, None] | None = None) -> dict[Var, None]:
    """The free variables of a term, in order of appearance."""
    found = {} if found is None else found
    term = deref(term)
    if type(term) is Var:
        found[term] = None
    for part in parts_of(term):
        variables_in(part, found)
    return found


def parts_of(term: Term) -> tuple[Term, ...]:
    """The terms that a term is made of."""
    if type(term) is Structure:
        return (*term.args, *term.annots)
    if type(term) is List:
        return tuple(term)
    if type(term) is OpenList:
        return (*term.items, term.tail)
    if type(term) is Code:
        return tuple(term.scope.values())
    return ()


def is_ground(term: Term) -> bool:
    return not variables_in(term)


def renamed(term: Term, names: dict[Var, Term]) -> Term:
    """The resolved term with each free variable replaced by a fresh one; `names` says which by which."""
    return substituted(resolve(term), names, fresh=True)


def substituted(term: Term, values: dict[Var, Term], fresh: bool = False) -> Term:
    """The term with variables replaced by what `values` says; with `fresh`, unknown ones get a new variable."""
    if type(term) in FIXED:
        return term
    if type(term) is Var:
        if fresh and term not in values:
            values[term] = Var(term.name)
        return values.get(term, term)
    return _with_parts(term, [substituted(part, values, fresh) for part in parts_of(term)])


def _with_parts(term: Term, parts: list[Term]) -> Term:
    if type(term) is Structure:
        count = len(term.args)
        return literal_of(term.predicate, tuple(parts[:count]), tuple(parts[count:]))
    if type(term) is List:
        return List(parts)
    if type(term) is OpenList:
        return OpenList(tuple(parts[:-1]), parts[-1])
    if type(term) is Code:
        return Code(term.body, dict(zip(term.scope, parts, strict=True)))
    return term


# ---- standard order ------------------------------------------------------------------------------------------------

_RANK: dict[type, int] = {int: 0, float: 0, String: 1, List: 2, OpenList: 2, Atom: 3, Structure: 3}


def compare(left: Term, right: Term) -> int:
    """-1, 0 or 1 in the standard order: numbers, strings, lists, literals by name and arguments, the rest."""
    left, right = deref(left), deref(right)
    rank_left, rank_right = _RANK.get(type(left), 4), _RANK.get(type(right), 4)
    if rank_left != rank_right:
        return -1 if rank_left < rank_right else 1
    return _COMPARERS[rank_left](left, right)


def _compare_values(left: str | float, right: str | float) -> int:
    return (left > right) - (left < right)  # type: ignore[operator]


def _compare_sequences(left: Iterable[Term], right: Iterable[Term]) -> int:
    left, right = tuple(left), tuple(right)
    for a, b in zip(left, right, strict=False):
        if order := compare(a, b):
            return order
    return _compare_values(len(left), len(right))


def _compare_lists(left: List | OpenList, right: List | OpenList) -> int:
    return _compare_sequences(parts_of(left), parts_of(right))


def _compare_literals(left: Atom | Structure, right: Atom | Structure) -> int:
    a, b = left.predicate, right.predicate
    return (
        _compare_values(a.namespace, b.namespace)
        or _compare_values(a.name, b.name)
        or _compare_values(a.negated, b.negated)
        or _compare_sequences(left.args, right.args)
        or _compare_sequences(left.annots, right.annots)
    )


def _compare_texts(left: Term, right: Term) -> int:
    return _compare_values(show(left), show(right))


_COMPARERS: tuple[Callable[..., int], ...] = (
    _compare_values,
    lambda left, right: _compare_values(str.__str__(left), str.__str__(right)),
    _compare_lists,
    _compare_literals,
    _compare_texts,
)


in_order = cmp_to_key(compare)
