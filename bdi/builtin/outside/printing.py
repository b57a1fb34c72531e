"""Output of text: `.print`, `.printf`, `.puts`, `.log`, …"""

import re

from bdi.builtin.arguments import bind, text_of
from bdi.builtin.kinds import ANY, NUMBER, OUT, STRING, optional, rest
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.errors import AgentSpeakSyntaxError
from bdi.language.parser import parse_term
from bdi.language.terms import String, Term, Var, show
from bdi.language.unify import deref, resolve, substituted, variables_in
from bdi.model.mind import Mind

LANGUAGE = "3.3"  # Jason's, whose meaning programs have here


def _line(args: tuple[Term, ...]) -> str:
    return "".join(map(text_of, args))


@internal_action("print", rest(ANY))
def print_line(mind: Mind, *args: Term) -> Answer:
    mind.say(_line(args))
    return True


internal_action("println", rest(ANY))(print_line)


@internal_action("log", ANY, rest(ANY))
def log(mind: Mind, level: Term, *args: Term) -> Answer:
    mind.say(f"[{text_of(level)}] {_line(args)}")
    return True


@internal_action("verbose", NUMBER)
def verbose(mind: Mind, level: Term) -> Answer:
    """Do nothing: an agent here prints nothing of its own accord; `listen` to it instead."""
    return True


@internal_action("version", OUT)
def version(mind: Mind, result: Term) -> Answer:
    """The version of the language that is spoken."""
    return bind(mind, result, String(LANGUAGE))


@internal_action("print_unifier", named=True)
def print_unifier(mind: Mind, names: dict[str, Term]) -> Answer:
    """The variables of the plan that have a value."""
    values = [(name, resolve(value)) for name, value in names.items() if not isinstance(deref(value), Var)]
    mind.say("{" + ", ".join(f"{name}={show(value)}" for name, value in values) + "}")
    return True


# ---- #{X + 1} ------------------------------------------------------------------------------------------------------

_INSERTED = re.compile(r"#\{([^{}]+)\}")


@internal_action("puts", STRING, optional(OUT), named=True)
def puts(mind: Mind, names: dict[str, Term], text: Term, result: Term | None = None) -> Answer:
    """.puts("battery #{B}")   .puts("twice #{2*B}",TEXT) gives the text instead of saying it"""
    filled = _INSERTED.sub(lambda found: _inserted(mind, names, found), text_of(text))
    if result is not None:
        return bind(mind, result, String(filled))
    mind.say(filled)
    return True


def _inserted(mind: Mind, names: dict[str, Term], found: "re.Match[str]") -> str:
    """The value of an expression; what is no expression stays as it is."""
    try:
        term = parse_term(found[1])
    except AgentSpeakSyntaxError:
        return found[0]
    values = {variable: names[variable.name] for variable in variables_in(term) if variable.name in names}
    return text_of(mind.logic.value_of(substituted(term, values)))


# ---- %5.1f ---------------------------------------------------------------------------------------------------------

_DIRECTIVE = re.compile(r"%([-+ 0,]*)(\d*)(\.\d+)?([a-zA-Z%])")


@internal_action("printf", STRING, rest(ANY))
def printf(mind: Mind, pattern: Term, *args: Term) -> Answer:
    """.printf("%5.1f volts of %s%n", V, battery): directives f, e, g, d, s, n and %."""
    left = list(args)
    mind.say(_DIRECTIVE.sub(lambda found: _formatted(found, left), text_of(pattern)).rstrip("\n"))
    return True


def _formatted(found: "re.Match[str]", left: list[Term]) -> str:
    flags, width, precision, directive = found[1], found[2], found[3] or "", found[4]
    if directive in "n%":
        return "\n" if directive == "n" else "%"
    if not left:
        raise wrong_arguments("printf", f"an argument for {found[0]}", "fewer")
    value = left.pop(0)
    if directive == "s":
        return f"{text_of(value):{'<' if '-' in flags else '>'}{width}{precision}}"
    if directive not in "fegd" or not isinstance(value, int | float):
        raise wrong_arguments("printf", f"for {found[0]} a number, and no directives but %f %e %g %d %s %n", value)
    sign = "+" if "+" in flags else " " if " " in flags else ""
    fill = "0" if "0" in flags and "-" not in flags else ""
    comma = "," if "," in flags else ""
    if directive == "d":
        value, precision, directive = float(value), ".0", "f"
    return f"{value:{'<' if '-' in flags else ''}{sign}{fill}{width}{comma}{precision}{directive}}"
