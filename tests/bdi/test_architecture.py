"""bdi/README.md names every module, in the package that holds it, and none that is not there."""

import re
from pathlib import Path

BDI = Path(__file__).parents[2] / "bdi"
ROW = re.compile(r"^\| `(\w+)` \| (.*) \|$", re.MULTILINE)


def modules(package: Path) -> set[str]:
    there = {path.stem for path in package.iterdir() if path.is_dir() or path.suffix == ".py"}
    return {name for name in there if not name.startswith("_")}


def test_the_readme_names_every_package_and_module() -> None:
    named = {
        package: set(re.findall(r"`(\w+)`", text)) for package, text in ROW.findall((BDI / "README.md").read_text())
    }
    assert named == {package: modules(BDI / package) for package in modules(BDI)}


def test_no_folder_shows_more_than_eighteen_entries_and_the_root_fourteen() -> None:
    def entries(folder: Path) -> int:
        return sum(not path.name.startswith(("__pycache__", ".")) for path in folder.iterdir())

    folders = [BDI, *(path for path in BDI.rglob("*") if path.is_dir() and path.name != "__pycache__")]
    crowded = {str(folder): entries(folder) for folder in folders if entries(folder) > 18}
    assert crowded == {}
    assert entries(BDI) <= 14
