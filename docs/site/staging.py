"""Copy the pages to where the site is built from.

In the repository a page links to code and to files beside docs/, which the site does not have: such a link becomes
its text with the file's path. Pages outside docs/ that readers need are copied in, and links follow them.
"""

import os.path
import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Final

CHECKOUT: Final = Path(__file__).parents[2]
DOCS: Final = CHECKOUT / "docs"
SOURCE: Final = CHECKOUT / "var" / "site-source"
SITE: Final = CHECKOUT / "var" / "site"

# Pages of the site that lie elsewhere in the repository.
ELSEWHERE: Final[Mapping[str, str]] = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security-reports.md",
    "CHANGELOG.md": "changelog.md",
    "examples/README.md": "examples.md",
    "client/README.md": "client.md",
}
KEPT: Final = {".md", ".yml", ".svg", ".webp", ".png", ".jpg", ".js", ".css"}
LINK: Final = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
SOURCE_ATTRIBUTE: Final = re.compile(r'((?:src|srcset|href)=")([^"]+)(")')
FENCE: Final = re.compile(r"^(```.*?^```)", re.MULTILINE | re.DOTALL)


def stage(into: Path) -> None:
    """Write every page and picture of the site into the folder, with links that hold there."""
    shutil.rmtree(into, ignore_errors=True)
    places = _places()
    for source, place in places.items():
        target = into / place
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.suffix == ".md":
            target.write_text(with_links(source.read_text(encoding="utf-8"), source, places), encoding="utf-8")
        else:
            shutil.copy(source, target)
    (into / "reference").mkdir(exist_ok=True)


def _places() -> dict[Path, Path]:
    """Where each file of the repository stands in the site."""
    places = {
        path: path.relative_to(DOCS)
        for path in sorted(DOCS.rglob("*"))
        if path.suffix in KEPT and path.is_file() and DOCS / "site" not in path.parents
    }
    places |= {CHECKOUT / path: Path(place) for path, place in ELSEWHERE.items() if (CHECKOUT / path).is_file()}
    return places | {DOCS / "site" / "iframe-worker.js": Path("assets/iframe-worker.js")}


def with_links(text: str, source: Path, places: Mapping[Path, Path]) -> str:
    """The page's text with links as the site needs them; code blocks stay as they are."""

    def link(found: re.Match[str]) -> str:
        picture, words, target = found.groups()
        there = _in_site(target, source, places)
        return f"{picture}[{words}]({there})" if there else _words_alone(words, target, source)

    def attribute(found: re.Match[str]) -> str:
        return found[1] + (_in_site(found[2], source, places) or found[2]) + found[3]

    parts = FENCE.split(text)
    parts[::2] = [SOURCE_ATTRIBUTE.sub(attribute, LINK.sub(link, part)) for part in parts[::2]]
    return "".join(parts)


def _in_site(target: str, source: Path, places: Mapping[Path, Path]) -> str | None:
    """The link's target in the site, or None for a file that only the repository has."""
    path, mark, anchor = target.partition("#")
    if not path or "://" in target or target.startswith("mailto:"):
        return target
    wanted = (source.parent / path).resolve()
    place = places.get(wanted) or places.get(wanted / "README.md")
    if place is None:
        return None if wanted.exists() else target  # a link that leads nowhere is for the build to refuse
    return os.path.relpath(place, places[source].parent) + mark + anchor


def _words_alone(words: str, target: str, source: Path) -> str:
    path = (source.parent / target.partition("#")[0]).resolve()
    name = str(path.relative_to(CHECKOUT)) if path.is_relative_to(CHECKOUT) else target
    return words if name in words or path.name in words else f"{words} (`{name}`)"
