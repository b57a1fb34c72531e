"""`make pages` writes what follows from other files: each page's list of the modules that it needs, and the types of
what the service sends, from its OpenAPI document. `--check` says what is not up to date instead.

*.html               their `preload` and `modulepreload` lines, so that no module waits for another to be read and no
                     answer of the service for a module
npm_modules.json     what any module of the pages needs of npm: the service worker keeps it
openapi_types.d.ts   a type for each schema; `api_types.ts` gives them the names that the pages use
"""

import argparse
import json
import os
import posixpath
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

WEB: Final = Path(__file__).parent
TYPES: Final = "openapi_types.d.ts"
NPM_MODULES: Final = "npm_modules.json"
MADE_BY_THE_SERVICE: Final = {"/page_files.js"}
IMPORT: Final = re.compile(
    r"""(?:^|[;\s}])(?:import|export)\s*(?:[\w$*{][^"';]*?from)?\s*["']([^"']+)["']""", re.MULTILINE
)
IMPORT_MAP: Final = re.compile(r"<script type=\"importmap\">(.*?)</script>", re.DOTALL)
PRELOADS: Final = re.compile(r"(?:    <link rel=\"(?:module)?preload\" [^>]+ />\n)*(?=    <script type=\"module\")")
MODULE: Final = '    <link rel="modulepreload" href="{}" />\n'
LATER_MODULE: Final = '    <link rel="modulepreload" href="{}" fetchpriority="low" />\n'
"""The page needs all of them; but what scripts ask for meanwhile, as the texts, shall not wait behind them."""
ANSWER: Final = '    <link rel="preload" as="fetch" href="{}" crossorigin />\n'
ASKED_BY_ALL: Final = ("/api/v1/about", "/api/v1/me")
ASKED_BY: Final[Mapping[str, tuple[str, ...]]] = {
    "index.html": ("/api/v1/map", "/api/v1/orders?role=all&amp;limit=6"),
    "mail.html": ("/api/v1/map",),
    "follow.html": ("/api/v1/map",),
}
"""What `early.js` asks for whatever the page's address is: begun while `early.js` is still on its way."""
SCRIPTS: Final = re.compile(r'<script type="module" src="([^"]+)"')


def with_preloads(name: str, html: str) -> str:
    """The page with a line for each module behind its scripts, in the order of their names; before them what the first
    script needs, since it begins as soon as it has that, and the answers that it asks for."""
    import_map = json.loads(_only(IMPORT_MAP, html))["imports"]
    early, *scripts = SCRIPTS.findall(html)
    first = [early, *sorted(modules_behind(early, import_map))]
    behind = (one for script in scripts for one in (*sorted(modules_behind(script, import_map)), script))
    others = [one for one in dict.fromkeys(behind) if one not in first]
    answers = [*ASKED_BY_ALL, *ASKED_BY.get(name, ())]
    lines = [*map(MODULE.format, first), *map(ANSWER.format, answers), *map(LATER_MODULE.format, others)]
    return PRELOADS.sub("".join(lines), html, count=1)


def _only(pattern: re.Pattern[str], html: str) -> str:
    (found,) = pattern.findall(html)
    return str(found)


def modules_behind(first: str, import_map: Mapping[str, str]) -> set[str]:
    """Every module that a module imports at once, at any depth, without itself; what `import()` fetches waits."""
    found: set[str] = set()
    waiting = [first]
    while waiting:
        module = waiting.pop()
        text = re.sub(r"/\*.*?\*/", "", file_of(module).read_text(encoding="utf-8"), flags=re.DOTALL)
        new = {resolve(module, name, import_map) for name in IMPORT.findall(text)} - found - MADE_BY_THE_SERVICE
        waiting += new
        found |= new
    return found - {first}


def npm_modules(import_map: Mapping[str, str]) -> str:
    """Those behind any module of ours, also behind one that is fetched only when it is needed."""
    ours = [file for file in WEB.rglob("*.js") if "node_modules" not in file.parts]
    behind = set().union(*(modules_behind(f"/{file.relative_to(WEB)}", import_map) for file in ours))
    return json.dumps(sorted(module for module in behind if module.startswith("/npm/")), indent=2) + "\n"


def resolve(module: str, name: str, import_map: Mapping[str, str]) -> str:
    """The address of what `module` imports as `name`."""
    if name.startswith("."):
        return posixpath.normpath(posixpath.join(posixpath.dirname(module), name))
    if name in import_map:
        return import_map[name]
    prefix = max((key for key in import_map if key.endswith("/") and name.startswith(key)), key=len)
    return import_map[prefix] + name.removeprefix(prefix)


def file_of(address: str) -> Path:
    """Where a module lies."""
    return WEB / address.replace("/npm/", "node_modules/", 1).removeprefix("/")


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
            sys.exit(f"openapi-typescript failed (is web/node_modules there? `make setup`):\n{done.stderr}")
        return made.read_text(encoding="utf-8")


def made_files() -> dict[Path, str]:
    """Every file that is made or has a made part, as it should be."""
    sys.path[:0] = [str(WEB.parent)]
    from client.make_client import document  # the checkout is on the path only now

    pages = {page: with_preloads(page.name, page.read_text(encoding="utf-8")) for page in sorted(WEB.glob("*.html"))}
    import_map = json.loads(_only(IMPORT_MAP, next(iter(pages.values()))))["imports"]
    return pages | {WEB / NPM_MODULES: npm_modules(import_map), WEB / TYPES: types_of(document())}


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
