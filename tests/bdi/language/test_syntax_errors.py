"""Common mistakes in programs, and the sentence that says how to correct each."""

import sys
from types import FrameType

import pytest

from bdi import AgentSpeakError, AgentSpeakSyntaxError, parse_program, parse_term

MISTAKES = [
    # the full stop
    ("+!g <- a", "1:9", "the text ends too early: '.' is missing"),
    ("+!g <- a\n+!h <- b.", "1:8", "'.' is missing after this"),
    ("+!g <- a;\n+!h <- b.", "1:9", "a plan ends with '.', not with ';'"),
    ("+!g <- a\n+b : c <- d.", "1:8", "'.' is missing after this"),
    ("!start\n+!start <- a.", "1:6", "'.' is missing after this"),
    ("p(1)\nq(2).", "1:4", "'.' is missing after this"),
    # between steps
    ("+!g <- a b.", "1:9", "';' is missing between two steps"),
    ("+!g <- a\n    !h.", "1:9", "';' is missing between two steps"),
    ("+!g <- a\n    +b; c.", "1:8", "';' is missing between a and +b"),
    ("+!g <- a, b.", "1:9", "the steps of a plan are separated by ';', not by ','"),
    ("+!g <- a; ; b.", "1:11", "unexpected ';'; expected '.' or a step"),
    ("+!g : a, b <- c.", "1:8", "conditions are joined by '&', not by ','"),
    # brackets
    (
        "+!g <- go(1;\n  stop.",
        "1:12",
        "unexpected ';' while the '(' of line 1, column 10 is open; expected ')', ',' or '|'",
    ),
    ("+!g <- p([1,2).", "1:14", "')' cannot close the '[' of line 1, column 10; expected ']'"),
    ("+!g <- p(1)).", "1:12", "')' closes no bracket"),
    ("+!g <- {a; b.", "1:13", "unexpected '.' while the '{' of line 1, column 8 is open; expected '}'"),
    (
        "p(f(1).",
        "1:7",
        "unexpected '.' while the '(' of line 1, column 2 is open; expected ')', ',' or '|'",
    ),
    ("+!g <- p(1,).", "1:12", "unexpected ')'; expected a formula"),
    ("{ begin namespace(n) }\nb.\n", "2:3", "the block of line 1, column 3 has no { end }"),
    # signs of other languages
    ("+!g : a and b <- c.", "1:9", "'and' is written '&'"),
    ("+!g : a or b <- c.", "1:9", "'or' is written '|'"),
    ("+!g : a && b <- c.", "1:9", "'&&' is written '&'"),
    ("+!g : a || b <- c.", "1:9", "'||' is written '|'"),
    ("+!g : X != 3 <- c.", "1:9", r"'!=' is written '\=='"),
    ("+!g : X =< 3 <- c.", "1:9", "'=<' is written '<='"),
    ("+!g <- X := 3.", "1:10", "':=' is written '='"),
    ("+!g -> c.", "1:5", "'->' is written '<-'"),
    ("+!g <- a. % why", "1:11", "'%' is written '//'"),
    ("+!g <- p(\u201cx\u201d).", "1:10", "'\u201c' is written '\"'"),
    # plans, rules, goals
    ("p <- q.", "1:3", "a plan begins with '+', '-' or '^', a rule is written ':-'"),
    ("+!g :- a.", "1:5", "':-' belongs to a rule, the body of a plan follows '<-'"),
    ("!g : c <- a.", "1:1", "a plan for a goal begins with '+!'"),
    ("+!g : !h <- a.", "1:7", "'!' begins a goal, which is no condition: what does not hold is written 'not'"),
    ("p :- q & !r.", "1:10", "'!' begins a goal, which is no condition: what does not hold is written 'not'"),
    ("+!g : X > <- b.", "1:11", "unexpected '<-'; expected a term"),
    ("+!g <- +3.", "1:8", "3 cannot be believed; expected a name"),
    ('+!g <- !"x".', "1:8", '"x" cannot be a goal; expected a name or a variable'),
    # names and words
    ("Foo(x).", "1:1", "'Foo' is a variable: a name begins with a small letter, 'foo'"),
    ("+!g <- Go(1).", "1:8", "'Go' is a variable: a name begins with a small letter, 'go'"),
    ("@L1 +!g <- a.", "1:2", "'L1' is a variable: a name begins with a small letter, 'l1'"),
    ("+!g <- if (a) {b}; else {c}.", "1:20", "'else' follows the '}' of an 'if'"),
    ("+!g <- if a {b}.", "1:11", "unexpected 'a'; expected '('"),
    ("+!g <- while (true) a.", "1:21", "unexpected 'a'; expected '{'"),
    # what never ends, and what is no text
    ('+!g <- p("abc).\n', "1:10", "this string has no closing quote on its line"),
    ("+!g <- 'abc.", "1:8", "this name has no closing quote on its line"),
    ("+!g <- a. /* why", "1:11", "this comment is never closed by '*/'"),
    (r'p("\q").', "1:3", r"there is no escape \q; expected \n, \t, \r, \b, \f, \", \' or \\"),
    ("p(1e999).", "1:3", "this number is too large"),
    ("p(\0).", "1:3", r"the character '\x00' means nothing here"),
    ("p(\ud800).", "1:3", r"the character '\ud800' means nothing here"),
]


@pytest.mark.parametrize(("text", "place", "sentence"), MISTAKES, ids=[text for text, _, _ in MISTAKES])
def test_a_mistake_is_said_so_that_it_can_be_mended(text: str, place: str, sentence: str) -> None:
    with pytest.raises(AgentSpeakSyntaxError) as caught:
        parse_program(text, source="robot.asl")
    line, column = map(int, place.split(":"))
    assert str(caught.value).splitlines()[0] == f"robot.asl:{place}: {sentence}"
    assert (caught.value.line, caught.value.column) == (line, column)
    shown = text.split("\n")[line - 1]
    if shown.strip():
        assert str(caught.value).splitlines()[1:] == [f"    {shown}", f"    {' ' * (column - 1)}^"]


HUGE = {
    "100,000 brackets": "p(" + "(" * 100_000 + "1" + ")" * 100_000 + ").",
    "100,000 lists": "p(" + "[" * 100_000 + "]" * 100_000 + ").",
    "100,000 plan bodies": "+!g <- " + "{" * 100_000 + "}" * 100_000 + ".",
    "100,000 open brackets": "p" + "(" * 100_000,
    "100,000 negations": "p :- " + "not " * 100_000 + "q.",
    "a sum of 100,000": "p(" + "1+" * 100_000 + "1).",
    "100,000 conditions": "p :- " + "q & " * 100_000 + "q.",
    "100,000 branches": "+!g <- " + "if (a) {b} el" * 100_000 + "se {c}.",
    "a name of 1 MB": "p" * 1_000_000 + ".",
    "a number of 1 MB": f"p({'9' * 1_000_000}).",
    "a string of 1 MB": f'p("{"x" * 1_000_000}).',
    "a string that never ends": '"' * 300_000,
    "names that never end": "a::" * 100_000,
    "dots": "." * 300_000,
    "comment signs": "/*" * 300_000,
    "slashes": "/ " * 300_000,
    "one wrong line of 1 MB": "a " * 500_000,
}


@pytest.mark.timeout(30)
@pytest.mark.parametrize("text", HUGE.values(), ids=HUGE.keys())
@pytest.mark.slow
def test_what_is_too_much_is_refused_in_time(text: str) -> None:
    for read in (parse_program, parse_term):
        try:
            read(text)
        except AgentSpeakError as error:
            assert len(str(error)) < 2_000_100  # it may name a token that is 1 MB long


@pytest.mark.slow
def test_reading_takes_work_in_proportion() -> None:
    """Calls are counted, since time is not the same twice."""

    def calls_for(count: int) -> int:
        text, calls = "+!g(X) : p(X) & not q <- a(X); !h; +b(X).\n" * count, 0

        def seen(frame: FrameType, event: str, argument: object) -> None:
            nonlocal calls
            calls += 1

        sys.setprofile(seen)
        try:
            parse_program(text)
        finally:
            sys.setprofile(None)
        return calls

    calls_for(1)
    assert calls_for(1_000) < 11 * calls_for(100)
