"""A map on which two bays of a post lie side by side."""

from pathlib import Path

_FORK = """
name = "fork"
title = "A post with two bays ahead"
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
[[post.bay]]
bearing_deg = 180.0
dock = true
home = true
[[post]]
name = "b"
x_m = 2.0
y_m = 0.0
[[post.bay]]
bearing_deg = {0}
[[post.bay]]
bearing_deg = {1}
[[corridor]]
ends = ["a", "b"]
"""


def fork(folder: Path, its_deg: float, other_deg: float) -> Path:
    """Return the file. From the home in the west of `a` a line leads east to `b`, whose bays are `b_bay1` in direction
    `its_deg` and `b_bay2` in direction `other_deg`."""
    file = folder / "fork.toml"
    file.write_text(_FORK.format(its_deg, other_deg))
    return file
