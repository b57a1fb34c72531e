"""Files that a power cut leaves old or new, never half: write beside, let it reach the disk, rename."""

import os
from pathlib import Path


def replace(temporary: Path, path: Path) -> None:
    """Rename a file that has been synced, and let the rename itself reach the disk. Raises OSError."""
    temporary.replace(path)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
