"""`make pages` writes what follows from other files: the pages' heads from the table below and their modules, and the
types of what the service sends, from its OpenAPI document. `--check` says what is not up to date instead.

public/*.html               one for each line of `HEADS`. Their `preload` and `modulepreload` lines are there so that no
                            module waits for another to be read and no answer of the service for a module
npm_modules.json            what any module of the pages needs of npm: the service worker keeps it
types/openapi_types.d.ts    a type for each schema; `api_types.ts` gives them the names that the pages use
"""

import argparse
import json
import os
import posixpath
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

WEB: Final = Path(__file__).parent
TYPES: Final = "types/openapi_types.d.ts"
NPM_MODULES: Final = "npm_modules.json"
MADE_BY_THE_SERVICE: Final = {"/src/offline/page_files.js"}
IMPORT: Final = re.compile(
    r"""(?:^|[;\s}])(?:import|export)\s*(?:[\w$*{][^"';]*?from)?\s*["']([^"']+)["']""", re.MULTILINE
)
LIT: Final = "/npm/joined/lit.js"
"""Its packages in one file, which `make setup` makes (docs/decisions/0041-answers-before-modules.md)."""
IMPORTS: Final = {"lit": LIT, "/npm/lit-html/lit-html.js": LIT, "lit-html/": "/npm/lit-html/"}
"""What asks for a part of it by its address, as directives do, is led to the same file: there must not be two."""
MODULE: Final = '<link rel="modulepreload" href="{}" />'
LATER_MODULE: Final = '<link rel="modulepreload" href="{}" fetchpriority="low" />'
"""The page needs all of them; but what scripts ask for meanwhile, as the texts, shall not wait behind them."""
ANSWER: Final = '<link rel="preload" as="fetch" href="{}" crossorigin />'
SCRIPT: Final = '<script type="module" src="{}"></script>'
STYLES: Final = '<link rel="stylesheet" href="/src/styles/{}.css" />'
INSTALLS: Final = '<link rel="manifest" href="/manifest.webmanifest" />'
SAYS_NOT_WHENCE: Final = '<meta name="referrer" content="no-referrer" />'
EARLY: Final = "/src/service/early.js"
ABOUT: Final = "/api/v1/about"
ME: Final = "/api/v1/me"


@dataclass(frozen=True)
class Head:
    """What one page has that others have not."""

    opens: str
    """The script that draws the shell, with a place in it for what the page shows."""
    styles: tuple[str, ...]
    shows: str | None = None
    """The module of the element in that place, if it has one of its own: the shell stands while that is on its way."""
    answers: tuple[str, ...] = ()
    """What `early.js` asks for whatever the page's address is: begun while `early.js` is still on its way."""
    by_link: bool = False
    """Whether people come by a link that is a secret, and without being signed in."""


HEADS: Final[Mapping[str, Head]] = {
    "index": Head("order", ("order",), "orders/order_page", ("/api/v1/map", "/api/v1/orders?role=all&amp;limit=6")),
    "follow": Head("follow", ("follow",), "follow/follow_page", ("/api/v1/map",)),
    "mail": Head("mail", ("mail",), "orders/mail_page", ("/api/v1/map",)),
    "notices": Head("notices", ("notices",), "settings/notifications_page"),
    "settings": Head("settings", ("settings",), "settings/settings_page"),
    "one-order": Head("one_order", ("follow",), "follow/one_order", ("/api/v1/map",), by_link=True),
    "mailroom": Head("mailroom", ("mailroom", "asking"), "mailroom/mailroom_page"),
    "robots": Head("robots", ("asking", "robots")),
    "print": Head("print", ("mailroom", "asking", "print")),
}
PAGE: Final = """<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8" />
    <title>Campus Mail</title>
    <meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover" />
    <meta name="description" content="Robots that carry letters across the campus" />
    <meta name="theme-color" content="#f6f3ec" media="(prefers-color-scheme: light)" />
    <meta name="theme-color" content="#101614" media="(prefers-color-scheme: dark)" />
    <link rel="icon" href="/icons/icon.svg" type="image/svg+xml" />
    {lines}
  </head>
  <body>
    <div id="page"></div>
    <noscript>Campus Mail needs JavaScript to follow robots as they drive.</noscript>
  </body>
</html>
"""


def html_of(head: Head) -> str:
    """A whole page: all else is drawn by its scripts."""
    scripts = [EARLY, f"/src/pages/{head.opens}.js", *([f"/src/{head.shows}.js"] if head.shows else ())]
    lines = [
        SAYS_NOT_WHENCE if head.by_link else INSTALLS,
        *map(STYLES.format, ("everywhere", *head.styles)),
        f'<script type="importmap">{json.dumps({"imports": IMPORTS})}</script>',
        *_begun(scripts, (ABOUT, *(() if head.by_link else (ME,)), *head.answers)),
        *map(SCRIPT.format, scripts),
    ]
    return PAGE.format(lines="\n    ".join(lines))


def _begun(scripts: list[str], answers: tuple[str, ...]) -> Iterator[str]:
    """A line for each module behind the scripts, script by script, in the order of their names; before them what the
    first script needs, since it begins as soon as it has that, and the answers that it asks for."""
    early, *others = ([*sorted(modules_behind(script)), script] for script in scripts)
    first = [EARLY, *early[:-1]]
    behind = dict.fromkeys(module for modules in others for module in modules if module not in first)
    yield from map(MODULE.format, first)
    yield from map(ANSWER.format, answers)
    yield from map(LATER_MODULE.format, behind)


def modules_behind(first: str) -> set[str]:
    """Every module that a module imports at once, at any depth, without itself; what `import()` fetches waits."""
    found: set[str] = set()
    waiting = [first]
    while waiting:
        module = waiting.pop()
        new = {resolve(module, name) for name in IMPORT.findall(code_of(module))} - found - MADE_BY_THE_SERVICE
        waiting += new
        found |= new
    return found - {first}


def npm_modules() -> str:
    """Those behind any module of ours, also behind one that is fetched only when it is needed."""
    ours = (WEB / "src").rglob("*.js")
    behind = set().union(*(modules_behind(f"/{file.relative_to(WEB)}") for file in ours))
    return json.dumps(sorted(module for module in behind if module.startswith("/npm/")), indent=2) + "\n"


def code_of(module: str) -> str:
    """The text of a module without its comments, which name types of other files as imports do."""
    return re.sub(r"/\*.*?\*/", "", file_of(module).read_text(encoding="utf-8"), flags=re.DOTALL)


def resolve(module: str, name: str) -> str:
    """The address of what `module` imports as `name`."""
    if name.startswith("."):
        address = posixpath.normpath(posixpath.join(posixpath.dirname(module), name))
        return IMPORTS.get(address, address)
    if name in IMPORTS:
        return IMPORTS[name]
    prefix = max((key for key in IMPORTS if key.endswith("/") and name.startswith(key)), key=len)
    return IMPORTS[prefix] + name.removeprefix(prefix)


def file_of(address: str) -> Path:
    """The file behind the address of a module."""
    if address.startswith("/src/"):
        return WEB / address[1:]
    return WEB / "node_modules" / address.removeprefix("/npm/")


def types_of(openapi: Mapping[str, Any]) -> str:
    """TypeScript for the document's schemas. Its paths are left out: only `api.js` knows addresses."""
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder, "openapi.json"), Path(folder, "types.d.ts")
        given.write_text(json.dumps({**openapi, "paths": {}}), encoding="utf-8")
        command = [WEB / "node_modules/.bin/openapi-typescript", given, "--output", made]
        # Where the system has no node of its own, setup has put one beside our Python.
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', '')}"
        done = subprocess.run(command, check=False, capture_output=True, text=True, env={**os.environ, "PATH": path})
        if done.returncode:
            sys.exit(f"openapi-typescript failed (is web/node_modules there? `make setup-develop`):\n{done.stderr}")
        return made.read_text(encoding="utf-8")


def made_files() -> dict[Path, str]:
    """Every file that is made, as it should be."""
    sys.path[:0] = [str(WEB.parent)]
    from client.make_client import document  # the checkout is on the path only now

    pages = {WEB / f"public/{name}.html": html_of(head) for name, head in HEADS.items()}
    return pages | {WEB / NPM_MODULES: npm_modules(), WEB / TYPES: types_of(document())}


def main() -> None:
    """Write, or check."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; fail if something is not up to date")
    is_check = parser.parse_args().check
    stale = [
        (file, text) for file, text in made_files().items() if not file.exists() or file.read_text("utf-8") != text
    ]
    if is_check and stale:
        sys.exit(f"Not up to date: {', '.join(file.name for file, _ in stale)}. Run `make pages`.")
    for file, text in stale:
        file.write_text(text, encoding="utf-8")
        sys.stdout.write(f"{file.name} written\n")


if __name__ == "__main__":
    main()
