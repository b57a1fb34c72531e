"""The example files of the messages, which tests and documents share."""

from pathlib import Path
from typing import Final

EXAMPLES: Final = Path(__file__).parent / "examples"


def examples_of(name: str) -> list[Path]:
    """The example files of a message type: `<type>.json` first, then its variants `<type>_<variant>.json`."""
    return sorted(path for path in EXAMPLES.glob(f"{name}*.json") if f"{path.stem}_".startswith(f"{name}_"))
