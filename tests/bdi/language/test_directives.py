"""Directives: where included files are looked for, functions of rules, and directives of one's own."""

from collections.abc import Iterable
from pathlib import Path

import pytest

from bdi import (
    Agent,
    AgentSpeakSyntaxError,
    Finished,
    IncludeCircle,
    IncludeNotFound,
    Includes,
    UnknownDirective,
    UnknownInternalAction,
    load_program,
    parse_program,
)
from bdi.language.syntax import Clause, Directive, Plan


def deeds(agent: Agent, cycles: int = 20) -> list[str]:
    seen: list[str] = []
    ended: list[Finished] = []
    for _ in range(cycles):
        outcome = agent.cycle(None, [], ended)
        ended = [Finished(action.id) for action in outcome.actions]
        seen += [*map(str, outcome.actions), *[failure.message for failure in outcome.failures]]
    return seen


@pytest.fixture
def folders(tmp_path: Path) -> Path:
    for name in ("robot", "lib", "site"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "who.asl").write_text(f"+!g <- {name}.\n")
    (tmp_path / "lib" / "only_lib.asl").write_text('{include("who.asl")}')
    (tmp_path / "site" / "only_site.asl").write_text("+!g <- only_site.")
    return tmp_path


# ---- include -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("who.asl", "robot"),  # beside the file that includes
        ("only_site.asl", "only_site"),  # along the search path
        ("only_lib.asl", "lib"),  # and from there again beside the file that includes
        ("../site/who.asl", "site"),
        ("$lib/who.asl", "lib"),
    ],
)
def test_an_included_file_is_found(folders: Path, name: str, found: str) -> None:
    (folders / "robot" / "main.asl").write_text(f'!g. {{include("{name}")}}')
    program = load_program(
        folders / "robot" / "main.asl",
        search_path=[folders / "lib", folders / "site"],
        remap={"lib": folders / "lib"},
    )
    assert deeds(Agent(program)) == [found]


def test_a_missing_file_names_every_place_that_was_looked_at(folders: Path) -> None:
    main = folders / "robot" / "main.asl"
    main.write_text('b.\n{ include("nowhere.asl") }')
    with pytest.raises(IncludeNotFound) as caught:
        load_program(main, search_path=[folders / "lib"])
    assert caught.value.line == 2
    assert f"there is no {folders}/robot/nowhere.asl and no {folders}/lib/nowhere.asl" in str(caught.value)


def test_an_unknown_remap_says_which_there_are(folders: Path) -> None:
    with pytest.raises(IncludeNotFound, match=r"nothing says what \$jar is; expected \$lib/ or \$site/"):
        parse_program('{include("$jar/x.asl")}', remap={"lib": folders, "site": folders})


def test_a_file_that_is_no_text_is_said_to_be_none(tmp_path: Path) -> None:
    (tmp_path / "picture.asl").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(IncludeNotFound, match=r"picture\.asl: not a text file"):
        parse_program('{include("picture.asl")}', source=str(tmp_path / "main.asl"))


def test_the_caller_may_read_files_from_elsewhere() -> None:
    asked: list[str] = []

    def read(path: Path) -> str:
        asked.append(path.as_posix())
        if path.as_posix() == "shelf/a.asl":
            return "+!g <- a."
        raise FileNotFoundError

    program = parse_program('!g. {include("a.asl")}', source="desk/main.asl", read=read, search_path=["shelf"])
    assert deeds(Agent(program)) == ["a"]
    assert asked == ["desk/a.asl", "shelf/a.asl"]


def test_one_file_twice_is_no_circle_but_a_circle_is_through_namespaces_too(tmp_path: Path) -> None:
    (tmp_path / "leaf.asl").write_text("b.")
    (tmp_path / "main.asl").write_text('{include("leaf.asl",x)} {include("leaf.asl",y)}')
    assert len(load_program(tmp_path / "main.asl").beliefs) == 2
    (tmp_path / "leaf.asl").write_text('{begin bdg(g)} {include("main.asl",z)} {end}')
    with pytest.raises(IncludeCircle, match=r"main\.asl includes itself"):
        load_program(tmp_path / "main.asl")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{include(file)}", 'include("file.asl")'),
        ('{include("a.asl", f(x))}', 'include("file.asl",space)'),
        ("{namespace(X)}", "namespace(name)"),
        ("{namespace(n, secret)}", "namespace(name,local)"),
        ("{begin namespace} {end}", "namespace(name)"),
        ('{register_function("f")}', 'register_function("name",1,"rule")'),
        ('{register_function(".f", 1, "g")}', 'register_function("name",1,"rule")'),
        ('{register_function("math.f", 1, "g")}', 'register_function("name",1,"rule")'),
    ],
)
def test_a_directive_with_wrong_arguments_is_refused_in_place(text: str, expected: str) -> None:
    with pytest.raises(AgentSpeakSyntaxError, match=r"<text>:2:1: .* has the wrong arguments") as caught:
        parse_program(f"b.\n{text}")
    assert expected in str(caught.value)


def test_an_unknown_directive_says_what_there_is() -> None:
    with pytest.raises(UnknownDirective) as caught:
        parse_program("{begin bdq(g)} {end}", directives={"twice": twice})
    message = str(caught.value)
    assert "unknown directive { begin bdq(g) }" in message
    assert all(name in message for name in ("include", "namespace", "register_function", "begin bdg", "twice"))


# ---- functions -----------------------------------------------------------------------------------------------------


def test_a_rule_is_a_function() -> None:
    text = """{register_function("area",2,"area_of")} {register_function("fact",1,"factorial")} side(3).
        area_of(X,Y,X*Y). factorial(0,1). factorial(N,N*F) :- N > 0 & factorial(N-1,F).
        !g. +!g : side(X) & area(X,2) > 5 <- Y = area(X,X)+1; show(Y, area(2,area(2,2)), fact(5));
            +big(area(4,4)); ?big(Z); show(Z)."""
    assert deeds(Agent(parse_program(text))) == ["show(10,8,120)", "show(16)"]


def test_an_internal_action_is_a_function() -> None:
    text = """{register_function("reversed",1,".reverse")} !g. +!g <- show(reversed([1,2,3]))."""
    assert deeds(Agent(parse_program(text))) == ["show([3,2,1])"]


def test_a_function_of_a_package_is_one_like_any_other_also_in_what_is_included_later(tmp_path: Path) -> None:
    (tmp_path / "later.asl").write_text("+!later <- show(my.sum(my.limit,1)).")
    text = """{register_function("my.sum",2,"sum")} {register_function("my.limit",0,"limit")} limit(10).
        sum(X,Y,X+Y). !g. +!g : my.sum(1,2) < 4 <- X = 5 + my.sum(1,my.limit); show(X);
            .include("later.asl"); !later."""
    agent = Agent(parse_program(text), includes=Includes(search_path=[tmp_path]))
    assert deeds(agent) == ["show(16)", "show(11)"]


def test_a_function_without_a_value_stays_an_expression() -> None:
    text = '{register_function("half",1,"half_of")} half_of(4,2). !g. +!g <- show(half(4), half(5)).'
    assert deeds(Agent(parse_program(text))) == ["show(2,half(5))"]


def test_a_function_of_a_module_is_made_of_the_rules_of_that_module() -> None:
    text = """{begin namespace(a)} {register_function("twice",1,"double")} double(X,2*X). {end} double(X,X).
        !g. +!g <- show(twice(4))."""
    assert deeds(Agent(parse_program(text))) == ["show(8)"]


def test_a_function_of_an_unknown_internal_action_is_refused_in_place() -> None:
    with pytest.raises(UnknownInternalAction, match=r"<text>:2:1: there is no internal action \.nonsense"):
        Agent(parse_program('b.\n{register_function("f",1,".nonsense")}'))


# ---- directives of one's own ---------------------------------------------------------------------------------------


def twice(directive: Directive, clauses: Iterable[Clause]) -> Iterable[Clause]:
    return [*clauses, *clauses]


def only(directive: Directive, clauses: Iterable[Clause]) -> Iterable[Clause]:
    """{ begin only(label) }: the plans with this label."""
    wanted = directive.term.args[0]
    return [each for each in clauses if isinstance(each, Plan) and each.label == wanted]


def test_a_directive_of_ones_own_changes_the_clauses_of_its_block() -> None:
    text = "{begin only(b)} @a +!g <- a. @b +!g <- b. {end} !g."
    assert deeds(Agent(parse_program(text, directives={"only": only}))) == ["b"]


def test_directives_in_directives_are_carried_out_from_the_inside() -> None:
    text = "{begin only(b)} {begin dg(g)} @a +!g <- a. @b +!g <- b. {end} {end} !g. -!g <- not_reached."
    assert deeds(Agent(parse_program(text, directives={"only": only}))) == ["b", "not_reached"]


def test_a_directive_of_ones_own_without_a_block_makes_clauses() -> None:
    def greeting(directive: Directive, clauses: Iterable[Clause]) -> Iterable[Clause]:
        return parse_program(f"+!greet <- say({directive.term.args[0]}).").plans

    program = parse_program("{greeting(hello)} !greet.", directives={"greeting": greeting})
    assert deeds(Agent(program)) == ["say(hello)"]


def test_a_file_loaded_while_the_agent_runs_may_use_it_too() -> None:
    includes = Includes(lambda path: "{begin only(b)} @a +!g <- a. @b +!g <- b. {end}", directives={"only": only})
    agent = Agent(parse_program('!go. +!go <- .include("g.asl"); !g.'), includes=includes)
    assert deeds(agent) == ["b"]


def test_what_a_directive_of_ones_own_gives_belongs_to_the_module() -> None:
    text = "{begin namespace(a)} {begin twice} count(1). +!g : count(N) <- show(N). {end} {end} !a::g. count(2)."
    assert deeds(Agent(parse_program(text, directives={"twice": twice}))) == ["show(1)"]
