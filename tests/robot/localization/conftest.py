"""A whole robot in stepped time."""

from tests.robot.daemon.conftest import run

__all__ = ["run"]
