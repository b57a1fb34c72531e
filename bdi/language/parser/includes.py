"""Included files: where they are searched, how they are read, and the directives in them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from bdi.language.errors import IncludeNotFound, Place
from bdi.language.syntax import Clause, Directive

Read = Callable[[Path], str]
Directives = Mapping[str, Callable[[Directive, tuple[Clause, ...]], Iterable[Clause]]]  # see `directives`


def read_file(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@dataclass(frozen=True, slots=True)
class Includes:
    """`{ include("parts/safety.asl") }`: first beside the file that includes, then in each folder of `search_path`.

    `remap` says what `$name/…` stands for, by name without the dollar sign: `{"lib": Path("/opt/agents")}` makes
    `$lib/safety.asl` the file /opt/agents/safety.asl. `read` gives the text of a file, or raises OSError. `directives`
    are the caller's own, by name.
    """

    read: Read = read_file
    search_path: Sequence[str | Path] = ()
    remap: Mapping[str, str | Path] = field(default_factory=dict)
    directives: Directives = field(default_factory=dict)

    def find(self, name: str, place: Place) -> tuple[Path, str]:
        """The file and its text. Raises IncludeNotFound, with every place that was looked at."""
        missing: list[str] = []
        for path in self._candidates(name, place):
            try:
                return path, self.read(path)
            except FileNotFoundError:
                missing.append(str(path))
            except (OSError, ValueError) as error:
                reason = getattr(error, "strerror", None) or "not a text file"
                raise IncludeNotFound(f"cannot include {path}: {reason}", place) from error
        raise IncludeNotFound(f"cannot include {name}: there is no {' and no '.join(missing)}", place)

    def _candidates(self, name: str, place: Place) -> list[Path]:
        if name.startswith("$"):
            prefix, _, rest = name[1:].partition("/")
            if prefix not in self.remap:
                known = tuple(f"${each}/" for each in sorted(self.remap)) or ("a file name",)
                raise IncludeNotFound(f"cannot include {name}: nothing says what ${prefix} is", place, known)
            return [Path(self.remap[prefix], rest)]
        folders = [Path(place.source).parent, *self.search_path]
        return list(dict.fromkeys(Path(folder, name) for folder in folders))
