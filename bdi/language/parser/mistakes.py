"""Messages of syntax errors, which say how to correct them."""

from collections.abc import Callable
from typing import NamedTuple

from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser.lalr import END, WORD, Parse, Stuck, Token, TooDeep, Unexpected
from bdi.language.parser.places import Places
from bdi.language.parser.repairs import kind_of, repair
from bdi.language.parser.tables import tables


class Reason(NamedTuple):
    """A sentence about a place, with what could have stood there."""

    problem: str
    start: int
    expected: tuple[str, ...] = ()


class Case(NamedTuple):
    """The state of the parser when it could not go on."""

    token: Token  # that cannot come now
    before: list[Token]
    parse: Parse
    places: Places

    @property
    def text(self) -> str:
        return self.places.text

    @property
    def last(self) -> Token:
        return self.before[-1] if self.before else Token(END, "", 0)

    def accepts(self, *signs: str) -> bool:
        return self.parse.accepts(*map(kind_of, signs))

    def clause(self) -> list[Token]:
        """Return the tokens since the last full stop."""
        ends = [place for place, token in enumerate(self.before) if token.text == "."]
        return self.before[ends[-1] + 1 :] if ends else self.before

    def open(self) -> list[Token]:
        """The brackets that wait for their other half."""
        waiting: list[Token] = []
        for token in self.before:
            if token.text in OPENING:
                waiting.append(token)
            elif token.text in CLOSING and waiting:
                waiting.pop()
        return waiting

    def expected(self) -> tuple[str, ...]:
        return _named(self.parse.expected())

    def where(self, token: Token) -> str:
        place = self.places.at(token.start)
        return f"line {place.line}, column {place.column}"


OPENING = {"(": ")", "[": "]", "{": "}"}
CLOSING = frozenset(OPENING.values())
STOPS = (".", ";", "<-", ":-")
SIGNS = ("+", "-", "^")  # a plan begins with one

# What other languages write, and what is written here.
FOREIGN = {
    "&&": "&",
    "||": "|",
    "=\\=": "\\==",
    "!==": "\\==",
    "===": "==",
    "!=": "\\==",
    "<>": "\\==",
    "\\=": "\\==",
    "=<": "<=",
    "=>": ">=",
    ":=": "=",
    "->": "<-",
    "%": "//",
    "#": "//",
    "\u201c": '"',
    "\u201d": '"',
    "\u2018": "'",
    "\u2019": "'",
    "\u2212": "-",
    "\u00ac": "not",
    "\u2227": "&",
    "\u2228": "|",
    "\u2190": "<-",
}
UNENDED = {
    "/*": "this comment is never closed by '*/'",
    '"': "this string has no closing quote on its line",
    "'": "this name has no closing quote on its line",
}


def mistake(stuck: Stuck, parse: Parse, places: Places) -> AgentSpeakSyntaxError:
    """The error for the person who wrote this text."""
    if isinstance(stuck, TooDeep):
        return AgentSpeakSyntaxError("this is nested too deeply", places.at(stuck.start))
    token = stuck.token if isinstance(stuck, Unexpected) else None
    case = Case(token or Token(END, "", stuck.start), parse.before, parse, places)
    reason = _of_character(case) if token is None else _of_token(case)
    return AgentSpeakSyntaxError(reason.problem, _place(reason.start, places), reason.expected)


def _place(start: int, places: Places) -> Place:
    """The end of the text is where its last line that says something ends."""
    return places.end_of(start) if start >= len(places.text) else places.at(start)


def _of_character(case: Case) -> Reason:
    start = case.token.start
    char = case.text[start]
    return _unended(case) or _foreign(case) or Reason(f"the character {char!r} means nothing here", start)


def _of_token(case: Case) -> Reason:
    for reason_for in REASONS:
        reason = reason_for(case)
        if reason is not None:
            return reason
    problem = "the text ends too early" if case.token.kind == END else f"unexpected '{case.token.text}'"
    return Reason(problem, case.token.start, case.expected())


# ---- reasons, the surest first -------------------------------------------------------------------------------------


def _unended(case: Case) -> Reason | None:
    for start in (case.token.start, case.token.start - 1):
        for opening, sentence in UNENDED.items():
            if start >= 0 and case.text.startswith(opening, start) and (len(opening) > 1 or start == case.token.start):
                return Reason(sentence, start)
    return None


def _foreign(case: Case) -> Reason | None:
    """a && b   X != 3"""
    start = case.token.start
    for foreign, ours in FOREIGN.items():
        for begin in range(start, start - len(foreign), -1):
            if begin >= 0 and case.text.startswith(foreign, begin) and "|||" not in case.text[begin - 1 : start + 2]:
                return Reason(f"'{foreign}' is written '{ours}'", begin)
    return None


def _unbalanced(case: Case) -> Reason | None:
    """p(1]   p(1.   p)"""
    token, waiting = case.token, case.open()
    if token.text in CLOSING:
        if not waiting:
            return Reason(f"'{token.text}' closes no bracket", token.start)
        if OPENING[waiting[-1].text] != token.text:
            opened = waiting[-1]
            return Reason(
                f"'{token.text}' cannot close the '{opened.text}' of {case.where(opened)}",
                token.start,
                (f"'{OPENING[opened.text]}'",),
            )
    if waiting and (token.kind == END or (token.text in STOPS and (token.text == "." or waiting[-1].text != "{"))):
        opened = waiting[-1]
        problem = "the text ends" if token.kind == END else f"unexpected '{token.text}'"
        return Reason(
            f"{problem} while the '{opened.text}' of {case.where(opened)} is open", token.start, case.expected()
        )
    return None


def _variable_for_name(case: Case) -> Reason | None:
    """Go(1)   !Go.   @L1"""
    token = case.token if case.token.kind == "VARIABLE" else case.last
    after = case.token.text if token is case.last else ""
    if token.kind != "VARIABLE" or (after != "(" and (after or not case.parse.accepts(WORD))):
        return None
    name = token.text.lstrip("_")
    small = f"{name[:1].lower()}{name[1:]}"
    if not small[:1].isalpha():
        return Reason(f"'{token.text}' is a variable, not a name", token.start, ("a name",))
    return Reason(f"'{token.text}' is a variable: a name begins with a small letter, '{small}'", token.start)


def _rule_and_plan(case: Case) -> Reason | None:
    """p <- q.   +!g :- a."""
    clause = [token for token in case.clause() if token.text not in ("{", "}")]
    is_plan = bool(clause) and clause[0].text in (*SIGNS, "@")
    if case.token.text == ":-" and is_plan:
        return Reason("':-' belongs to a rule, the body of a plan follows '<-'", case.token.start)
    if case.token.text in ("<-", ":") and clause and clause[0].kind == WORD:
        return Reason("a plan begins with '+', '-' or '^', a rule is written ':-'", case.token.start)
    if case.token.text in ("<-", ":") and clause and clause[0].text == "!":
        return Reason("a plan for a goal begins with '+!'", clause[0].start)
    return None


def _goal_as_condition(case: Case) -> Reason | None:
    """+!g : !at(home) <- a."""
    before = case.last.text
    if case.token.text != "!" or before not in (":", "&", "|", "not", ":-", "<:"):
        return None
    return Reason("'!' begins a goal, which is no condition: what does not hold is written 'not'", case.token.start)


def _full_stop(case: Case) -> Reason | None:
    """The clause before has no full stop; often it shows only at the sign after the sign of the next plan."""
    token, last = case.token, case.last
    if token.kind == END:
        return Reason("the text ends too early: '.' is missing", token.start) if case.accepts(".") else None
    if token.text in ("!", "?") and last.text in SIGNS:
        return _stop_before(case, last)
    if token.text in ("<-", ":"):
        begins = [each for each in case.clause()[1:] if each.text in SIGNS and case.places.is_first_on_line(each.start)]
        return _stop_before(case, begins[-1]) if begins else None
    begins_clause = token.text in (*SIGNS, "@", "!") or token.kind in (WORD, kind_of("~"))
    if begins_clause and case.accepts(".") and case.places.is_first_on_line(token.start) and not _in_body(case):
        return _stop_before(case, token)
    return _stop_before(case, token) if token.text == "@" and case.accepts(".") else None


def _stop_before(case: Case, token: Token) -> Reason:
    end = len(case.text[: token.start].rstrip())
    if case.text[:end].endswith(";"):
        return Reason("a plan ends with '.', not with ';'", end - 1)
    return Reason("'.' is missing after this", max(0, end - 1))


def _in_body(case: Case) -> bool:
    return any(token.text == "<-" for token in case.clause())


def _written_today(case: Case) -> Reason | None:
    """and   missing ;"""
    found = repair(case.parse, case.token)
    return Reason(found.sentence, found.start) if found else None


def _comma(case: Case) -> Reason | None:
    """a, b"""
    if case.token.text != "," or not case.parse.accepted(kind_of("&")):
        return None
    if case.parse.accepted(kind_of(";")):
        return Reason("the steps of a plan are separated by ';', not by ','", case.token.start)
    return Reason("conditions are joined by '&', not by ','", case.token.start)


def _block(case: Case) -> Reason | None:
    """{ begin d } without { end }"""
    if case.token.kind != END or not case.parse.accepts(kind_of("{"), tables().words["end"]):
        return None
    begins = [token for token in case.before if token.kind == tables().words["begin"]]
    ended = sum(token.kind == tables().words["end"] for token in case.before)
    return Reason(f"the block of {case.where(begins[-1 - ended])} has no {{ end }}", case.token.start)


def _keyword(case: Case) -> Reason | None:
    """else without if, if without a condition"""
    words = tables().words
    if case.last.text in ("else", "elif") and case.last.kind == WORD:
        return Reason(f"'{case.last.text}' follows the '}}' of an 'if'", case.last.start)
    if case.token.text in words and case.token.text not in ("begin", "end"):
        return Reason(f"'{case.token.text}' is a word of the language and cannot stand here", case.token.start)
    return None


REASONS: tuple[Callable[[Case], Reason | None], ...] = (
    _unended,
    _foreign,
    _unbalanced,
    _comma,
    _block,
    _rule_and_plan,
    _full_stop,
    _goal_as_condition,
    _keyword,
    _variable_for_name,
    _written_today,
)


# ---- names ---------------------------------------------------------------------------------------------------------

_NAMES = {
    "ATOM": "a name",
    "VARIABLE": "a variable",
    "NUMBER": "a number",
    "STRING": "a string",
    "INTERNAL": "an internal action",
    "RELATION": "a comparison",
    END: "the end",
}


_VALUE = ["ATOM", "VARIABLE", "NUMBER", "STRING", "INTERNAL", "(", "[", "{", "~", "+", "-"]
_GROUPS = (
    (["!", "!!", "?", "+<", "+>", "if", "while", "for", "not", *_VALUE], "a step"),
    (["not", *_VALUE], "a formula"),
    (_VALUE, "a term"),
    (["ATOM", "+", "-", "^", "@", "!", "{", "~"], "a belief, rule, goal or plan"),
)


def _named(kinds: list[str]) -> tuple[str, ...]:
    """Tokens as people write them, the punctuation first."""
    texts = {name: text for text, name in (*tables().signs.items(), *tables().words.items())}
    left = {texts.get(kind, kind) for kind in kinds}
    names = []
    for group, name in _GROUPS:
        if left.issuperset(group):
            left.difference_update(group)
            names.append(name)
    names += [_NAMES.get(each) or f"'{each}'" for each in left]
    return tuple(sorted(names, key=lambda name: (not name.startswith("'"), name)))
