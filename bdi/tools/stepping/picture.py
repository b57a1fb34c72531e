"""A cycle as one reads it in a terminal: event, plans and why not, step, what came of it, and the intentions.

cycle 5 ────────────────────────────────────────────────────────────────────
event    +!travel(post5)
plans    ✗ by_line   12  line(center) does not hold (believed: line(lost))
         ✓ search    15  P=post5
step     drive(spiral)                                           mail.asl:15
action   drive(spiral)
beliefs  + driving(spiral)
         - line(center)
doing    1  +!travel(post5)   search  waits for action drive(spiral)
            +!deliver(post5)  p__2    next: hand_over
"""

from collections.abc import Iterable, Iterator, Sequence

from rich.console import ConsoleRenderable, Group
from rich.rule import Rule
from rich.table import Table
from rich.text import Text

from bdi.debug.trace import CHOSEN, ERROR, HEAD, WOULD_APPLY, Deliberated, Failed, Stepped, Verdict, brief
from bdi.language.terms import show
from bdi.tools.stepping.stepper import Cycle, Stack

INDENT = 9
MARKS = {CHOSEN: ("✓", "green"), WOULD_APPLY: ("·", "dim"), ERROR: ("!", "yellow")}
NOT_TAKEN = ("✗", "red")
LONGEST_LABEL = 20
LEAST_GOAL = 24
_LEFT_OUT = frozenset({"code", "code_src", "code_line"})
SHOWN_EVENTS = 6
SHOWN_CHANGES = 12  # of beliefs in a cycle; the rest is counted


def picture(cycle: Cycle, named: bool) -> ConsoleRenderable:
    """`named`: whether to say whose cycle it was."""
    title = f"cycle {cycle.number}" + (f"  {cycle.agent}" if named else "")
    heading = Rule(Text(title, "bold"), align="left", style="dim")
    parts: list[ConsoleRenderable] = [heading]
    for entry in cycle.entries:
        if isinstance(entry, Deliberated):
            parts += _choice(entry)
        elif isinstance(entry, Stepped):
            parts.append(_step(entry))
        elif isinstance(entry, Failed):
            parts.append(_row("failed", Text(f"{entry.goal}: {entry.message} ({entry.error})", "red")))
    parts += _outcome(cycle)
    parts += _changes(cycle)
    if len(parts) == 1:
        parts.append(_row("", Text("nothing happens", "dim")))
    parts += intentions(cycle.stacks)
    parts += waiting(cycle.waiting)
    return Group(*parts)


def _row(title: str, content: ConsoleRenderable) -> Table:
    row = Table.grid(padding=0)
    row.add_column(width=INDENT, style="dim", no_wrap=True)
    row.add_column(overflow="fold")
    row.add_row(title, content)
    return row


def _rows(title: str, contents: Iterable[Text]) -> list[ConsoleRenderable]:
    return [_row("" if place else title, content) for place, content in enumerate(contents)]


def _choice(choice: Deliberated) -> list[ConsoleRenderable]:
    parts: list[ConsoleRenderable] = [_row("event", _event(choice))]
    if choice.verdicts:
        parts.append(_row("plans", _plans(choice.verdicts)))
    elif choice.event.intention is None or choice.event.trigger.value not in "+-":
        parts.append(_row("plans", Text("there is none", "red")))
    return parts


def _event(choice: Deliberated) -> Text:
    """The event, its annotations dimmed; without where a failure happened, which the steps before have shown."""
    event = choice.event
    annots = [show(annot) for annot in event.literal.annots if getattr(annot, "functor", "") not in _LEFT_OUT]
    extra = [text for text in annots if text != "source(self)" and text.removeprefix("reason(")[:-1] not in annots]
    return Text.assemble((str(event), "bold"), (f"[{','.join(extra)}]" if extra else "", "dim"))


def _plans(verdicts: Sequence[Verdict]) -> Table:
    several = len({verdict.source for verdict in verdicts}) > 1
    table = Table.grid(padding=(0, 1))
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True, max_width=LONGEST_LABEL)
    table.add_column(no_wrap=True, justify="right", style="dim")
    table.add_column(overflow="fold")
    for verdict in verdicts:
        mark, style = MARKS.get(verdict.verdict, NOT_TAKEN)
        where = f"{short(verdict.source)}:{verdict.line}" if several else str(verdict.line)
        name = Text(verdict.plan, "bold" if verdict.verdict == CHOSEN else "")
        table.add_row(Text(mark, style), name, where, _reason(verdict))
    return table


def _reason(verdict: Verdict) -> Text:
    known = ", ".join(f"{name}={value}" for name, value in verdict.bindings)
    if verdict.verdict == CHOSEN:
        return Text(known)
    return Text(verdict.why, "dim" if verdict.verdict in (WOULD_APPLY, HEAD) else "")


def short(source: str) -> str:
    """The name of a file without its folders."""
    return source.rpartition("/")[2]


def _step(entry: Stepped) -> Table:
    table = Table.grid(padding=0, expand=True)
    table.add_column(width=INDENT, style="dim", no_wrap=True)
    table.add_column(overflow="fold", ratio=1)
    table.add_column(justify="right", style="dim", no_wrap=True)
    place = entry.step.place
    table.add_row("step", brief(entry.step), f"{short(place.source)}:{place.line}, intention {entry.intention}")
    return table


def _outcome(cycle: Cycle) -> Iterator[ConsoleRenderable]:
    outcome = cycle.outcome
    yield from _rows("action", [Text(str(action), "bold cyan") for action in outcome.actions])
    yield from _rows("says", map(Text, outcome.printed))
    yield from _rows("sends", [Text(f"{m.performative} {show(m.content)} to {m.receiver}") for m in cycle.sent])
    yield from _rows("cancels", [Text(f"action {number}", "yellow") for number in outcome.cancelled])


def _changes(cycle: Cycle) -> list[ConsoleRenderable]:
    changes = [_change("+", text, "green") for text in cycle.added]
    changes += [_change("-", text, "red") for text in cycle.removed]
    hidden = len(changes) - SHOWN_CHANGES
    if hidden > 0:
        changes = [*changes[:SHOWN_CHANGES], Text(f"… and {hidden} more", "dim")]
    return _rows("beliefs", changes)


def _change(sign: str, belief: str, style: str) -> Text:
    fact, bracket, source = belief.rpartition("[") if belief.endswith("]") else (belief, "", "")
    return Text.assemble((f"{sign} {fact}".lstrip(), style), (bracket + source, "dim"))


def intentions(stacks: Sequence[Stack]) -> list[ConsoleRenderable]:
    """Each intention with its plans, the newest first."""
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True, style="dim", justify="right")
    table.add_column(no_wrap=True, overflow="ellipsis", min_width=LEAST_GOAL)
    table.add_column(no_wrap=True, style="dim", max_width=LONGEST_LABEL)
    table.add_column(overflow="fold")
    for stack in stacks:
        for place, level in enumerate(stack.levels):
            first = place == 0
            now = Text(stack.state) if first else Text(f"then {level.next_step or 'it is done'}", "dim")
            table.add_row(str(stack.number) if first else "", level.event, level.plan, now)
    return [_row("doing", table)] if stacks else []


def waiting(events: Sequence[str]) -> list[ConsoleRenderable]:
    """Events whose turn comes later."""
    more = [f"… and {len(events) - SHOWN_EVENTS} more"] if len(events) > SHOWN_EVENTS else []
    return [_row("waiting", Text(", ".join([*events[:SHOWN_EVENTS], *more])))] if events else []


def belief(text: str) -> Text:
    """A belief, its source dimmed."""
    return _change("", text, "")
