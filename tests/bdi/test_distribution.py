"""The language as a distribution of its own: built, installed beside Lark alone, and used outside the checkout."""

import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "bdi" / "README.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def run(*words: str | Path, cwd: Path, check: bool = True) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, cwd=cwd, capture_output=True, text=True, check=check, timeout=60)


def files_of(folder: Path) -> Iterator[Path]:
    return (path for path in folder.rglob("*") if "__pycache__" not in path.parts)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    before = set(files_of(ROOT / "bdi"))
    run(sys.executable, "-m", "pip", "wheel", "--no-deps", "-q", "-w", folder, ROOT / "bdi", cwd=folder)
    assert set(files_of(ROOT / "bdi")) == before, "building leaves nothing in the checkout"
    [built] = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def python(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The interpreter of a fresh environment with the wheel and what it depends on."""
    folder = tmp_path_factory.mktemp("fresh")
    run(sys.executable, "-m", "venv", "--without-pip", "env", cwd=folder)
    python = folder / "env" / "bin" / "python"
    run(sys.executable, "-m", "pip", "--python", python, "install", "-q", wheel, cwd=folder)
    return python


@pytest.mark.nightly
def test_the_wheel_has_every_module_the_grammar_and_the_licence_and_the_version_of_the_project(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    modules = {f"bdi/{path.relative_to(ROOT / 'bdi')}" for path in files_of(ROOT / "bdi") if path.suffix == ".py"}
    data = {"bdi/py.typed", "bdi/language/parser/agentspeak.lark", "bdi/language/parser/tables.json"}
    assert {name for name in names if name.startswith("bdi/")} == modules | data
    assert any(name.endswith("licenses/LICENSE") for name in names)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert wheel.name.split("-")[:2] == ["agentspeak_bdi", project["version"]]
    assert tomllib.loads((ROOT / "bdi" / "pyproject.toml").read_text())["project"]["license"] == project["license"]


def test_the_program_of_the_readme_runs_beside_lark_alone(python: Path, tmp_path: Path) -> None:
    blocks = [text for _, text in BLOCK.findall(README)]
    program, caller, printed = (
        next(text for text in blocks if mark in text) for mark in ("!deliver", "load_program", "action: charge\naction")
    )
    (tmp_path / "courier.asl").write_text(program)
    assert run(python, "-c", caller, cwd=tmp_path).stdout == printed
    packages = next(python.parent.parent.glob("lib/*/site-packages"))
    assert {path.name for path in packages.iterdir() if not path.name.endswith(".dist-info")} == {"bdi", "lark"}


def test_without_the_extra_the_command_says_what_it_needs(python: Path, tmp_path: Path) -> None:
    ended = run(python.with_name("agentspeak"), "--help", cwd=tmp_path, check=False)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert "pip install 'agentspeak-bdi[tools]'" in ended.stderr
