"""No text, however mangled, makes the mind raise anything but an error of the program, and what it reads it runs."""

from collections.abc import Callable
from itertools import islice
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bdi import AgentSpeakError, parse_literal, parse_plan, parse_term
from benchmarks.fuzz_mind import Author, Report, check, mangled, measure, real_programs, texts

steady = settings(derandomize=True, deadline=None, database=None, suppress_health_check=list(HealthCheck))
SIGNS = "+-!?^@.,;:|&~()[]{}<>=*/'\"\\_%#\0\n\t 019abpXYÄé\ud800"
WORDS = [
    "not",
    "if",
    "else",
    "while",
    "for",
    "div",
    "mod",
    "begin",
    "end",
    "<-",
    ":-",
    ":",
    "&",
    "|",
    ";",
    ".",
    "(",
    ")",
]


@given(st.text(SIGNS, max_size=60))
@settings(steady, max_examples=300)
def test_any_characters(text: str) -> None:
    check(text, Report())


@given(st.lists(st.sampled_from([*WORDS, "+!g", "p(X)", "q", "X", "1", '"s"', "[a]", "{", "}", "+", "!"]), max_size=20))
@settings(steady, max_examples=300)
def test_any_words_of_the_language(words: list[str]) -> None:
    check(" ".join(words), Report())
    check(f"+!g : {' '.join(words)}.", Report())
    check(f"!g. +!g <- {' '.join(words)}.", Report())


@given(st.randoms(use_true_random=False))
@settings(steady, max_examples=200)
@pytest.mark.slow
def test_real_programs_after_accidents(random: Random) -> None:
    check(mangled(random, real_programs()), Report())


@given(st.randoms(use_true_random=False))
@settings(steady, max_examples=200)
@pytest.mark.slow
def test_programs_made_up(random: Random) -> None:
    check(Author(random).program(), Report())


@given(st.text(SIGNS, max_size=30))
@settings(steady, max_examples=300)
def test_any_characters_as_a_term_or_plan(text: str) -> None:
    for read in (parse_term, parse_literal, parse_plan):
        try:
            read(text)
        except AgentSpeakError:
            continue


@pytest.mark.parametrize("term", ["f(X)", "f(X,X)", "[X]", "[a|X]", "X[a]", "f(Y)[X]", "{p(X)}"])
@pytest.mark.parametrize("step", ["?n(X)", "p(X)", "+n(X)", ".print(X)", "X = 1", "!k(X)", "?(X == 1)"])
def test_a_term_that_contains_itself_fails_its_plan_at_most(term: str, step: str) -> None:
    check(f"!h. +!h <- !g(X); a. +!g(X) <- X = {term}; {step}.", Report())
    check(f"!h. +!h : X = {term} <- {step}. -!h[error(E)] <- said(E).", Report())


def test_the_benchmark_finds_programs_among_its_texts_and_nothing_wrong() -> None:
    report = measure(300, seed=7)
    assert report.failures == []
    assert report.cases == 300
    assert report.read > 60
    assert report.run > 40
    assert list(islice(texts(7), 5)) == list(islice(texts(7), 5))


NESTED: dict[str, Callable[[int], str]] = {
    "terms": lambda deep: f"!g. +!g <- X = {'f(' * deep}1{')' * deep}; p(X); +b(X); ?b(Y); .print(Y).",
    "heads": lambda deep: f"!g({'f(' * deep}1{')' * deep}). +!g({'f(' * deep}X{')' * deep}) <- p(X).",
    "lists": lambda deep: f"!g. +!g <- X = {'[' * deep}{']' * deep}; p(X).",
    "conditions": lambda deep: f"b(1). !g. +!g : {' & '.join(f'b(X{number})' for number in range(deep))} <- p.",
    "rules": lambda deep: f"b. r :- {' & '.join(['b'] * deep)}. !g. +!g : r <- p.",
    "negations": lambda deep: f"b. !g. +!g : {'not ' * deep}b <- p. -!g <- q.",
    "sums": lambda deep: f"!g(1). +!g(Y) <- X = {'+'.join(['Y'] * deep)}; p(X).",
    "elif": lambda deep: f"!g. +!g <- if (c) {{a}} {'elif (c) {b} ' * deep} else {{p}}.",
    "loops": lambda deep: f"b(1). !g. +!g <- {'for (b(X)) {' * deep}p{'}' * deep}.",
    "bodies": lambda deep: f"!g. +!g <- X = {'{' * deep}p{'}' * deep}; X.",
    "branches": lambda deep: f"!g. +!g <- {'(a |&| ' * deep}p{')' * deep}.",
    "annotations": lambda deep: f"!g. +!g <- X = {'f[' * deep}a{']' * deep}; p(X).",
    "sub-plans": lambda deep: f"!g. +!g <- p. {'{ +!h. ' * deep}{'}' * deep}",
    "blocks": lambda deep: f"{'{ begin namespace(n) } ' * deep}b.{' { end }' * deep}",
}


@pytest.mark.parametrize("nest", NESTED.values(), ids=NESTED.keys())
@pytest.mark.slow
def test_what_is_nested_runs_or_is_refused_however_deep(nest: Callable[[int], str]) -> None:
    report = Report()
    for deep in (1, 5, 10, 15, 20, 30, 40, 50, 70, 90, 110, 130, 1000):
        check(nest(deep), report)
    assert 4 < report.read < report.cases  # some of it is usual, the deepest is not
