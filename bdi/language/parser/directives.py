"""Directives: `{ name(…) }` and `{ begin name(…) } … { end }`.

A directive of one's own is a function from the directive, as it is written, and the clauses of its block (none without
a block) to the clauses that stand there instead:

    def twice(directive, clauses):  # { begin twice } … { end }
        return [*clauses, *clauses]

    parse_program(text, directives={"twice": twice})

`directive.term` has the arguments, `directive.place` where it stands. The function may raise AgentSpeakError.
"""

from bdi.language.errors import AgentSpeakSyntaxError, UnknownDirective
from bdi.language.parser.includes import Directives
from bdi.language.parser.namespaces import Module
from bdi.language.parser.patterns import PATTERNS
from bdi.language.syntax import Clause, Directive, Function
from bdi.language.terms import THIS_SPACE, Atom, String, Var, is_internal, predicate

OF_FILES = ('include("file.asl")', 'include("file.asl",space)')
OF_SPACES = ("namespace(name)", "namespace(name,local)")
OF_FUNCTIONS = ('register_function("name",1,"rule")',)
OUR_PACKAGES = (".", "math.", "system.")  # no program defines functions of these
BUILT_IN = (*OF_FILES, *OF_SPACES, *OF_FUNCTIONS)


def expanded(directive: Directive, clauses: tuple[Clause, ...], own: Directives) -> list[Clause]:
    """Return the clauses that replace a directive: a goal pattern, or a directive of the caller's own."""
    name = directive.term.functor
    expand = own.get(name) or (PATTERNS.get(name) if directive.clauses is not None else None)
    if expand is None:
        raise unknown(directive, own)
    return list(expand(directive, clauses))


def unknown(directive: Directive, own: Directives) -> UnknownDirective:
    begin = "" if directive.clauses is None else "begin "
    known = (*BUILT_IN, *(f"begin {name}(…)" for name in PATTERNS), *sorted(own))
    return UnknownDirective(
        f"unknown directive {{ {begin}{directive.term} }}", directive.place, tuple(f"{{ {each} }}" for each in known)
    )


def file_of(directive: Directive) -> str:
    """`include("file")`, `include("file",space)`: the file."""
    args = directive.term.args
    if not 0 < len(args) < 3 or not isinstance(args[0], String):
        raise wrong(directive, OF_FILES)
    return str.__str__(args[0])


def space_of(directive: Directive, module: Module) -> str:
    """The namespace that a file is loaded into: ours, one that is named, or a fresh one for a variable."""
    args = directive.term.args
    if len(args) < 2:
        return module.space
    if isinstance(args[1], Var):
        return module.fresh()
    if type(args[1]) is not Atom:
        raise wrong(directive, OF_FILES)
    return module.named(args[1].functor)


def declared_space(directive: Directive, module: Module) -> str:
    """`namespace(name)`, `namespace(name,local)`, `namespace(name,global)`: its name. A local one is local from here
    on, in this file."""
    name, *kind = directive.term.args or (None,)
    if type(name) is not Atom or len(kind) > 1 or not {str(each) for each in kind} <= {"local", "global"}:
        raise wrong(directive, OF_SPACES)
    if kind and str(kind[0]) == "local":
        module.declare_local(name.functor)
    return name.functor


def function_of(directive: Directive, module: Module) -> Function:
    """`register_function("name",arity,"rule")`: `name(X)` is the Y for which `rule(X,Y)` holds."""
    args = directive.term.args
    if len(args) != 3 or not isinstance(args[0], String) or type(args[1]) is not int or not isinstance(args[2], String):
        raise wrong(directive, OF_FUNCTIONS)
    if args[0].startswith(OUR_PACKAGES):
        raise wrong(directive, OF_FUNCTIONS)
    space, _, target = str.__str__(args[2]).rpartition("::")
    space = "" if is_internal(target) else module.named(space or THIS_SPACE)
    return Function(str.__str__(args[0]), args[1], predicate(target, args[1] + 1, False, space), directive.place)


def wrong(directive: Directive, expected: tuple[str, ...]) -> AgentSpeakSyntaxError:
    return AgentSpeakSyntaxError(
        f"{{ {directive.term} }} has the wrong arguments", directive.place, tuple(f"{{ {each} }}" for each in expected)
    )
