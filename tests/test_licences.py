"""Files that may be shipped under our licence: the pages that say so, and the check of what is installed beside us."""

import json
import os
import runpy
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent
SCRIPT = ROOT / ".ci" / "bill_of_materials.py"


REFUSED = runpy.run_path(str(SCRIPT))["refused"]


@pytest.mark.parametrize(
    ("licences", "may_ship"),
    [
        ([{"license": {"id": "MIT"}}], True),
        ([{"license": {"id": "GPL-3.0-only"}}], False),
        ([{"license": {"id": "LGPL-2.1-only"}}], False),
        ([{"expression": "MIT OR GPL-2.0-only"}], True),
        ([{"expression": "MIT AND GPL-2.0-only"}], False),
        ([{"expression": "BSD-3-Clause AND (MIT AND Zlib)"}], True),
        ([{"license": {"name": "License :: OSI Approved :: GNU Affero General Public License v3"}}], False),
        ([{"license": {"id": "MIT"}}, {"license": {"id": "GPL-3.0-only"}}], False),
        ([], False),
    ],
)
def test_a_licence_that_asks_more_than_ours_is_refused(licences: list[Any], may_ship: bool) -> None:
    said = REFUSED({"components": [{"name": "thing", "version": "1.0", "licenses": licences}]})
    assert (said == []) is may_ship, said
    assert all("thing 1.0" in line for line in said)


def test_every_package_of_ours_names_the_licence() -> None:
    files = [ROOT / "pyproject.toml", ROOT / "client" / "pyproject.toml"]
    named = [tomllib.loads(file.read_text())["project"]["license"] for file in files]
    assert named == ["Apache-2.0", "Apache-2.0"]
    assert "Version 2.0, January 2004" in (ROOT / "LICENSE").read_text()
    assert "license: Apache-2.0" in (ROOT / "CITATION.cff").read_text()


@pytest.mark.nightly
def test_the_bills_name_what_is_shipped_and_nothing_that_cannot_be(tmp_path: Path) -> None:
    with_npm = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    subprocess.run([sys.executable, SCRIPT, tmp_path], check=True, capture_output=True, env=with_npm)
    python = json.loads((tmp_path / "python.cdx.json").read_text())
    names = {one["name"].lower() for one in python["components"]}
    assert {"fastapi", "starlette", "lark", "numpy", "asyncpg"} <= names
    assert not {"pytest", "mypy", "schemathesis"} & names
    pages = json.loads((tmp_path / "pages.cdx.json").read_text())
    assert {"lit", "lit-html"} <= {one["name"] for one in pages["components"]} and pages["bomFormat"] == "CycloneDX"
    assert REFUSED(python) + REFUSED(pages) == []
