"""Maps for tests: text in, file out."""

from collections.abc import Callable
from pathlib import Path

import pytest

WriteMap = Callable[[str], Path]


@pytest.fixture
def write_map(tmp_path: Path) -> WriteMap:
    """Write a map file; the head (name and title) is added where the text has none."""

    def write(text: str) -> Path:
        path = tmp_path / "campus.toml"
        head = "" if "name = " in text.partition("[[")[0] else 'name = "campus"\ntitle = "Campus"\n'
        path.write_text(head + text, encoding="utf-8")
        return path

    return write
