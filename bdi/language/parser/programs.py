"""Text to program, with everything that it includes."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from bdi.language.errors import IncludeCircle, Place
from bdi.language.parser.clauses import Warn, with_own_labels
from bdi.language.parser.directives import declared_space, expanded, file_of, function_of, space_of
from bdi.language.parser.includes import Directives, Includes, Read, read_file
from bdi.language.parser.namespaces import Module, Numbers
from bdi.language.parser.texts import parse
from bdi.language.syntax import Belief, Clause, CompatibilityWarning, Directive, Function, Goal, Plan, Program, Rule


def load_program(
    path: str | Path,
    *,
    search_path: Sequence[str | Path] = (),
    remap: Mapping[str, str | Path] | None = None,
    directives: Directives | None = None,
    compatible: bool = False,
    warn: Warn | None = None,
) -> Program:
    """The program in this file, with everything it includes. Raises AgentSpeakError; OSError if it cannot be read."""
    text = read_file(Path(path))
    return parse_program(
        text,
        str(path),
        search_path=search_path,
        remap=remap,
        directives=directives,
        compatible=compatible,
        warn=warn,
    )


def parse_program(
    text: str,
    source: str = "<text>",
    read: Read | None = None,
    *,
    search_path: Sequence[str | Path] = (),
    remap: Mapping[str, str | Path] | None = None,
    directives: Directives | None = None,
    compatible: bool = False,
    warn: Warn | None = None,
) -> Program:
    """A program with its includes in place. Included files are searched as `includes.Includes` says.

    `read` gives the text of an included file (by default from disk), `directives` are the caller's own, by name (see
    `directives`). With `compatible` what older programs write is read, too (see `repairs`); `Program.warnings` says
    where, and `warn` is called at once. Raises AgentSpeakSyntaxError, IncludeNotFound, IncludeCircle, UnknownDirective.
    """
    collected = _Collected(Includes(read or read_file, search_path, remap or {}, directives or {}))
    if compatible:
        collected.warn = _both(collected.warnings.append, warn)
    collected.add_file(text, source, Module(numbers=collected.numbers).of_file(text, ""))
    return collected.program(source)


def load_module(name: str, space: str | None, loader: Includes, so_far: Program) -> tuple[Program, str]:
    """A file for an agent that is running, and the namespace it is loaded into (None: a fresh one).

    `so_far` is what the agent was made of: the file is searched beside it. Raises as `parse_program`.
    """
    path, text = loader.find(name, Place(so_far.source))
    collected = _Collected(loader, so_far)
    outside = Module(numbers=collected.numbers)
    module = outside.of_file(text, outside.fresh() if space is None else space)
    collected.add_file(text, str(path), module)
    return collected.program(str(path)), module.space


def _both(keep: Warn, tell: Warn | None) -> Warn:
    def warn(warning: CompatibilityWarning) -> None:
        keep(warning)
        if tell is not None:
            tell(warning)

    return warn


class _Collected:
    """A program while its files are read, each where it is included."""

    def __init__(self, includes: Includes, so_far: Program | None = None) -> None:
        self.includes = includes
        self.numbers = Numbers(so_far.namespaces if so_far else 0)
        self.first_plan = len(so_far.plans) + 1 if so_far else 1
        self.beliefs: list[Belief | Rule] = []
        self.goals: list[Goal] = []
        self.plans: list[Plan] = []
        self.functions: list[Function] = []
        self.sources: list[str] = []
        self.warnings: list[CompatibilityWarning] = []
        self.warn: Warn | None = None  # in the compatibility mode
        self.open: list[Path] = []  # the files that are being read, each included by the one before

    def program(self, source: str) -> Program:
        return Program(
            source,
            tuple(self.beliefs),
            tuple(self.goals),
            tuple(with_own_labels(self.plans, self.first_plan)),
            tuple(self.sources),
            tuple(self.functions),
            self.numbers.taken,
            tuple(self.warnings),
        )

    # ---- files

    @contextmanager
    def reading(self, source: str) -> Iterator[None]:
        self.sources.append(source)
        self.open.append(Path(source).resolve())
        yield
        self.open.pop()

    def include(self, directive: Directive, module: Module) -> None:
        """{ include("file") }, { include("file", space) }"""
        space = space_of(directive, module)
        path, text = self.found(directive)
        self.add_file(text, str(path), module.of_file(text, space))

    def add_file(self, text: str, source: str, module: Module) -> None:
        with self.reading(source):
            self.add(parse(text, "program", source, self.warn), module)

    def found(self, directive: Directive) -> tuple[Path, str]:
        path, text = self.includes.find(file_of(directive), directive.place)
        if path.resolve() in self.open:
            raise IncludeCircle(f"{path} includes itself", directive.place)
        return path, text

    # ---- clauses

    def add(self, clauses: Iterable[Clause], module: Module) -> None:
        for clause in clauses:
            if isinstance(clause, Directive):
                self.obey(clause, module)
            else:
                self.keep(module.clause(clause))

    def keep(self, clause: Clause) -> None:
        if isinstance(clause, Plan):
            self.plans.append(clause)
        elif isinstance(clause, Goal):
            self.goals.append(clause)
        elif isinstance(clause, Belief | Rule):
            self.beliefs.append(clause)

    def obey(self, directive: Directive, module: Module) -> None:
        name = directive.term.functor
        if name == "include":
            self.include(directive, module)
        elif name == "namespace":
            space = declared_space(directive, module)
            self.add(directive.clauses or (), module.inner(space))
        elif name == "register_function":
            self.functions.append(function_of(directive, module))
        else:
            module.prefixes = True  # of the plans that a pattern makes
            self.add(expanded(directive, tuple(self.flat(directive.clauses or ())), self.includes.directives), module)

    def flat(self, clauses: Iterable[Clause]) -> Iterator[Clause]:
        """The clauses of a block with the directives in it carried out, so that the one around them sees it all. What
        is in a namespace of its own stays apart."""
        for clause in clauses:
            if not isinstance(clause, Directive) or clause.term.functor in ("namespace", "register_function"):
                yield clause
            elif clause.term.functor != "include":
                yield from expanded(clause, tuple(self.flat(clause.clauses or ())), self.includes.directives)
            elif len(clause.term.args) > 1:
                yield clause
            else:
                path, text = self.found(clause)
                with self.reading(str(path)):
                    yield from self.flat(parse(text, "program", str(path), self.warn))
