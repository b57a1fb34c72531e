"""Write CycloneDX bills of materials of what a campus installs, and check the licences that they name.

Service and robot need what `pyproject.toml` asks for, and what that needs in turn; the pages need what npm installs for
production. Tools of tests and checks are left out, though they lie in the same environment.
"""

import json
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path
from typing import Any

from license_expression import ExpressionError, Licensing
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parent.parent
LICENSING = Licensing()
SHIPPED_EXTRAS = ("service", "robot", "postgres", "pi")

ALLOWED = {
    "0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "CC0-1.0", "HPND", "ISC", "MIT", "MIT-0", "MIT-CMU",
    "PSF-2.0", "Unlicense", "Zlib",
    # Weak copyleft by file: shipping it unchanged asks nothing of our files (https://www.apache.org/legal/resolved.html).
    "MPL-2.0",
    # As packages without an SPDX expression name them.
    "Apache Software License", "BSD License", "MIT License", "Mozilla Public License 2.0 (MPL 2.0)",
}  # fmt: skip
"""What software under Apache-2.0 can ship with."""


def asked_for() -> list[str]:
    """The requirements of service and robot, as `pyproject.toml` has them."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    return [*project["dependencies"], *(one for extra in SHIPPED_EXTRAS for one in extras[extra])]


def shipped(lines: list[str]) -> dict[str, None]:
    """Canonical names of all that these requirements bring on this machine, each once, in the order found."""
    found: dict[str, None] = {}
    todo = [(line, "") for line in lines]
    seen = set()
    while todo:
        line, of_extra = todo.pop()
        requirement = Requirement(line)
        if (line, of_extra) in seen or (requirement.marker and not requirement.marker.evaluate({"extra": of_extra})):
            continue
        seen.add((line, of_extra))
        try:
            needed = requires(requirement.name) or []
        except PackageNotFoundError:
            # Only a robot's own computer has it: it is not in the environment that is looked at.
            continue
        found[canonicalize_name(requirement.name)] = None
        todo += [(one, name) for one in needed for name in ("", *requirement.extras)]
    return found


def python_bill() -> dict[str, Any]:
    """The bill of materials of this environment, without what is not shipped."""
    made = [sys.executable, "-m", "cyclonedx_py", "environment", sys.prefix, "--pyproject", "pyproject.toml"]
    bill: dict[str, Any] = json.loads(subprocess.run(made, check=True, capture_output=True, cwd=ROOT).stdout)
    names = shipped(asked_for())
    bill["components"] = [one for one in bill["components"] if canonicalize_name(one["name"]) in names]
    kept = {one["bom-ref"] for one in bill["components"]} | {bill["metadata"]["component"]["bom-ref"]}
    bill["dependencies"] = [
        one | {"dependsOn": [ref for ref in one.get("dependsOn", ()) if ref in kept]}
        for one in bill["dependencies"]
        if one["ref"] in kept
    ]
    return bill


def pages_bill() -> dict[str, Any]:
    """Return what npm installs for the pages, by their lock file."""
    made = ["npm", "sbom", "--sbom-format", "cyclonedx", "--omit", "dev", "--package-lock-only"]
    bill: dict[str, Any] = json.loads(subprocess.run(made, check=True, capture_output=True, cwd=ROOT / "web").stdout)
    return bill


def refused(bill: dict[str, Any]) -> list[str]:
    """Each component with a licence that is not allowed, or with none, as a line for people."""
    lines = []
    for component in bill["components"]:
        named = [_name(one) for one in component.get("licenses", ())]
        if not named or not all(map(_is_allowed, named)):
            lines.append(f"{component['name']} {component['version']}: {', '.join(named) or 'no licence named'}")
    return lines


def _name(entry: dict[str, Any]) -> str:
    name = entry.get("expression") or entry["license"].get("id") or entry["license"].get("name", "")
    return str(name).rsplit(" :: ", 1)[-1]


def _is_allowed(text: str) -> bool:
    """By name, or as an SPDX expression of what is allowed."""
    if text in ALLOWED:
        return True
    try:
        parsed = LICENSING.parse(text)
    except ExpressionError:
        return False
    known = {one: LICENSING.TRUE if one.key in ALLOWED else LICENSING.FALSE for one in parsed.symbols}
    return bool(parsed.subs(known, simplify=True) == LICENSING.TRUE)


def write(folder: Path) -> None:
    """Write both bills into this folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, bill in (("python", python_bill()), ("pages", pages_bill())):
        file = folder / f"{name}.cdx.json"
        file.write_text(json.dumps(bill, indent=1) + "\n")
        print(f"{file}: {len(bill['components'])} components")


def check() -> int:
    """Print what cannot be shipped; the exit status says whether there is such a thing."""
    bills = python_bill(), pages_bill()
    bad = [line for bill in bills for line in refused(bill)]
    for line in bad:
        print(f"Apache-2.0 software cannot ship with {line}", file=sys.stderr)
    print(f"{sum(len(bill['components']) for bill in bills)} components, {len(bad)} that cannot be shipped")
    return 1 if bad else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["check"]:
        sys.exit(check())
    write(Path(sys.argv[1]))
