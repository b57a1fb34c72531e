"""The tables of the parser: what Lark makes of `agentspeak.lark`, kept in `tables.json`.

Making them takes Lark and 0.2 s, reading them 2 ms. After a change of the grammar they are made anew at every start,
until `python -m bdi.language.parser.tables` has written them.
"""

import json
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

GRAMMAR = Path(__file__).with_name("agentspeak.lark")
KEPT = Path(__file__).with_name("tables.json")
STARTS = ("program", "formula")

Row = dict[str, int]  # terminal or rule → next state (0 and up) or the production to reduce by (~number)


class Production(NamedTuple):
    """A rule of the grammar. `method` builds its value from the children; without one it is its only child, or the
    children are spliced into the rule above."""

    origin: str
    size: int
    method: str
    kept: list[int]  # which symbols are children; with ~ before those that are spliced in
    spliced: bool  # itself


class Tables(NamedTuple):
    rows: list[Row]
    productions: list[Production]
    starts: dict[str, int]
    ends: dict[str, int]
    tokens: list[tuple[str, str]]  # names and patterns, in the order in which they are tried; "" is ignored
    signs: dict[str, str]  # "<-" → its name
    words: dict[str, str]  # "if" → its name


@lru_cache(maxsize=1)
def tables() -> Tables:
    """The tables of the grammar."""
    grammar = GRAMMAR.read_text(encoding="utf-8")
    of_grammar, rows, productions, *others = json.loads(KEPT.read_bytes())
    if of_grammar != grammar:
        return make(grammar)
    return Tables(rows, [Production(*production) for production in productions], *others)


def written(grammar: str) -> str:
    """The text of `tables.json`, with a line for each row and production."""
    rows, productions, *others = make(grammar)
    lists = [
        "[\n" + ",\n".join(json.dumps(each, separators=(",", ":"), sort_keys=True) for each in part) + "]"
        for part in (rows, productions)
    ]
    return (
        "[" + ",\n".join([json.dumps(grammar), *lists, *(json.dumps(part, sort_keys=True) for part in others)]) + "]\n"
    )


def make(grammar: str) -> Tables:
    """Lark's tables of this grammar, in the form that `lalr` reads."""
    from lark import Lark
    from lark.parsers.lalr_analysis import Shift

    lark = Lark(grammar, parser="lalr", start=list(STARTS), maybe_placeholders=False)
    table: Any = lark.parser.parser._parse_table  # the one place where we look into Lark
    rules = sorted(lark.rules, key=repr)
    reductions = {rule: ~number for number, rule in enumerate(rules)}
    states = _numbered(table)
    rows: list[Row] = [{} for _ in states]
    for state, actions in table.states.items():
        for symbol, (action, target) in actions.items():
            rows[states[state]][symbol] = states[target] if action is Shift else reductions[target]
    starts, ends = (
        {name: states[state] for name, state in each.items()} for each in (table.start_states, table.end_states)
    )
    return Tables(rows, [_production(rule) for rule in rules], starts, ends, *_terminals(lark))


def _numbered(table: Any) -> dict[int, int]:
    """The states in an order that is the same every time: as they are met from the starts."""
    met = dict.fromkeys(table.start_states[start] for start in STARTS)
    waiting = list(met)
    while waiting:
        actions = table.states[waiting.pop()]
        for _, target in (actions[symbol] for symbol in sorted(actions)):
            if isinstance(target, int) and target not in met:
                met[target] = None
                waiting.append(target)
    return {state: number for number, state in enumerate(met)}


def _production(rule: Any) -> Production:
    name = rule.origin.name
    spliced = name.startswith("_")
    kept = [
        ~place if not symbol.is_term and symbol.name.startswith("_") else place
        for place, symbol in enumerate(rule.expansion)
        if not (symbol.is_term and symbol.filter_out)
    ]
    single = rule.options.expand1 and not rule.alias and len(kept) == 1
    return Production(name, len(rule.expansion), "" if spliced or single else rule.alias or name, kept, spliced)


def _terminals(lark: Any) -> tuple[list[tuple[str, str]], dict[str, str], dict[str, str]]:
    tokens: list[tuple[str, str]] = []
    signs: dict[str, str] = {}
    words: dict[str, str] = {}
    for terminal in sorted(lark.terminals, key=lambda each: (-each.pattern.max_width, each.name)):
        text = terminal.pattern.value
        if terminal.pattern.type == "str":
            (words if text.isalpha() else signs)[text] = terminal.name
        else:
            tokens.append(("" if terminal.name in lark.ignore_tokens else terminal.name, text))
    return tokens, signs, words


if __name__ == "__main__":
    KEPT.write_text(written(GRAMMAR.read_text(encoding="utf-8")), encoding="utf-8")
