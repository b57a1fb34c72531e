"""The client as a distribution of its own."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).parents[2]


@pytest.fixture
def client(tmp_path: Path) -> Path:
    """A copy of the client's folder, beside the file that has the version."""
    shutil.copy(CHECKOUT / "pyproject.toml", tmp_path)
    copied: Path = shutil.copytree(CHECKOUT / "client", tmp_path / "client", ignore=lambda *_: {"__pycache__"})
    return copied


def built(client: Path) -> subprocess.CompletedProcess[str]:
    command = (sys.executable, "-m", "pip", "wheel", "--no-deps", "--quiet", "--wheel-dir", client.parent, client)
    return subprocess.run(command, cwd=client.parent, capture_output=True, text=True, check=False, timeout=100)


@pytest.mark.nightly
def test_the_wheel_has_what_make_client_writes(client: Path) -> None:
    assert built(client).returncode == 0
    [wheel] = client.parent.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    assert {
        f"campus_mail_client/{name}.py" for name in ("async_client", "client", "models", "operations", "problems")
    } <= names


@pytest.mark.nightly
def test_a_client_that_is_not_written_yet_is_not_built_and_says_what_to_run(client: Path) -> None:
    (client / "campus_mail_client" / "problems.py").unlink()
    refused = built(client)
    assert refused.returncode != 0
    assert "problems: not written yet. Run `make client`" in refused.stderr
    assert not [*client.parent.glob("*.whl")]
