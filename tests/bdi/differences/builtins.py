"""Internal actions."""

from tests.bdi.differences import happenings, shows


@shows("version")
def version() -> None:
    assert happenings("!g. +!g <- .version(V); p(V).") == ['1 p("3.3")'] or happenings(
        "!g. +!g <- .version(V); p(V)."
    ) == ['2 p("3.3")']


@shows("random-without-end")
def random_without_end() -> None:
    assert happenings("!g. +!g <- .count(.random(X,0), N); p(N).") == ["2 p(10000)"]


@shows("printf")
def printf() -> None:
    assert happenings('!g. +!g <- .printf("%d and %5.2f", 3, 2.5).') == ["1 says 3 and  2.50"]


@shows("src-info")
def src_info() -> None:
    program = "!g.\n+!g <-\n  .get_src_info(b(1), R);\n  p(R)."
    assert happenings(program) == ['2 p(b(1)[code_src("<text>"),code_line(2)])']


@shows("map-get")
def map_get() -> None:
    program = "!g. +!g <- .map.create(M); .map.put(M,a,1); .map.put(M,b,2); .findall(f(K,V), .map.get(M,K,V), L); p(L)."
    assert happenings(program) == ["5 p([f(a,1),f(b,2)])"]


@shows("filled-at-once")
def filled_at_once() -> None:
    program = "!g. +!g <- .queue.create(Q,[c,a]); .queue.head(Q,H); .set.create(S,[b,a,b]); .length(S,N); p(H,N)."
    assert happenings(program) == ["5 p(c,2)"]


@shows("nth")
def nth() -> None:
    assert happenings("!g. +!g <- .nth(3,[a],X). -!g[error(E)] <- why(E).") == ["2 why(wrong_arguments)"]


@shows("by-identity")
def by_identity() -> None:
    program = "!g. +!g <- .set.create(A,[1]); .set.create(B,[1]); if (A == B) { same } else { other }."
    assert happenings(program)[-1].endswith(" other")


@shows("regular-expressions")
def regular_expressions() -> None:
    assert happenings('!g. +!g <- .replace("post4", "(?P<name>[a-z]+)", "<$1>", T); p(T).') == ['2 p("<post>4")']


@shows("same-label")
def same_label() -> None:
    program = "@p +!a <- x. !g. +!g <- .add_plan({ @p +!b <- y }). -!g[error(E)] <- why(E)."
    assert happenings(program) == ["2 why(ia_failed)"]
