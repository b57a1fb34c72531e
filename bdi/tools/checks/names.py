"""Names that look alike: the same but for case, an underscore or one letter."""

from collections.abc import Iterable, Iterator

from bdi.language.syntax import Trigger
from bdi.language.terms import PRIVATE_SPACE, Literal, Predicate, Var
from bdi.language.unify import Trail, renamed, undo, unify
from bdi.tools.checks.findings import Finding, Severity, place_of
from bdi.tools.checks.reading import How, Reading, Use

SHORTEST = 4  # letters, for one wrong letter to say anything


def spelled(key: Predicate) -> str:
    return repr(key) if not key.namespace.startswith(PRIVATE_SPACE) else f"{key.name}/{key.arity}"


def folded(name: str) -> str:
    return name.replace("_", "").lower()


def alike(left: str, right: str) -> bool:
    """goTo and goto, go_to and goto, drive and dirve; not post1 and post2."""
    if left == right:
        return False
    if folded(left) == folded(right):
        return True
    return min(len(left), len(right)) >= SHORTEST and _one_letter_apart(left, right) and not _numbered(left, right)


def _numbered(left: str, right: str) -> bool:
    return left.rstrip("0123456789") == right.rstrip("0123456789")


def _one_letter_apart(left: str, right: str) -> bool:
    """One letter more, fewer or other, or two neighbours exchanged."""
    if abs(len(left) - len(right)) > 1:
        return False
    start = 0
    while start < min(len(left), len(right)) and left[start] == right[start]:
        start += 1
    a, b = left[start:], right[start:]
    return a[1:] == b[1:] or a[1:] == b or a == b[1:] or (a[:2] == b[1::-1] and a[2:] == b[2:] and len(a) > 1)


def similar(key: Predicate, others: Iterable[Predicate]) -> Predicate | None:
    """The one that was probably meant: of the same name with another arity, or of a name that looks alike."""
    candidates = sorted(others, key=lambda other: (other.name != key.name, other.arity != key.arity, other.name))
    return next((each for each in candidates if each.name == key.name or alike(each.name, key.name)), None)


def look_alikes(reading: Reading) -> Iterator[Finding]:
    """Two names of one kind that differ by case or an underscore."""
    goals = [*reading.of(How.POSTED), *_heads(reading, Trigger.GOAL_ADDED)]
    beliefs = [*reading.of(How.TESTED), *reading.of(How.ADDED), *_heads(reading, Trigger.BELIEF_ADDED)]
    kinds = {"goal": goals, "belief": beliefs, "action": list(reading.of(How.DONE))}
    for kind, uses in kinds.items():
        yield from _folding(kind, uses)


def _heads(reading: Reading, trigger: Trigger) -> list[Use]:
    plans = [plan for plan in reading.plans if plan.trigger is trigger and not isinstance(plan.head, Var)]
    return [Use(How.TESTED, plan.head, plan.place, plan) for plan in plans if not isinstance(plan.head, Var)]


def _folding(kind: str, uses: list[Use]) -> Iterator[Finding]:
    first: dict[str, Use] = {}
    reported: set[str] = set()
    for use in uses:
        name = use.literal.functor
        other = first.setdefault(folded(name), use)
        if other.literal.functor != name and name not in reported:
            reported.add(name)
            yield Finding(
                "look-alike",
                Severity.WARNING,
                place_of(name, use.place),
                f"the {kind} {name} and the {kind} {other.literal.functor} (line {other.place.line}) are two names",
                "write one name for one thing, and names that differ clearly for two",
            )


def forgotten_marks(reading: Reading) -> Iterator[Finding]:
    """An action called like a goal or a belief: a ! or + is missing, most likely."""
    reported: set[Predicate] = set()
    goals = reading.heads(Trigger.GOAL_ADDED)
    believed = {use.literal.predicate for use in reading.of(How.ADDED) if use.plan is not None}
    for use in reading.of(How.DONE):
        key = use.literal.predicate
        if key in reported:
            continue
        if key in goals and not _is_the_action_of(reading, key):
            reported.add(key)
            yield _forgotten(use, f"there are plans for the goal !{spelled(key)}", f"!{use.literal} if that was meant,")
        elif key in believed and key not in goals:
            reported.add(key)
            meant = f"?{use.literal} to ask for it or +{use.literal} to believe it,"
            yield _forgotten(use, f"the program believes {spelled(key)} by +{key.name}", meant)


def _is_the_action_of(reading: Reading, key: Predicate) -> bool:
    """`+!dock <- dock.`: the goal is achieved by the action of its name."""
    return any(
        use.literal.predicate is key and use.plan is not None and getattr(use.plan.head, "predicate", None) is key
        for use in reading.of(How.DONE)
    )


def _forgotten(use: Use, why: str, meant: str) -> Finding:
    return Finding(
        "forgotten-mark",
        Severity.WARNING,
        use.place,
        f"{use.literal} is an action here, but {why}",
        f"write {meant} or give the action another name",
    )


def unifies(left: Literal | Var, right: Literal) -> bool:
    trail: Trail = []
    found = unify(renamed(left, {}), renamed(right, {}), trail)
    undo(trail, 0)
    return found
