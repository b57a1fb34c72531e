"""Robots become known: a maintainer makes a one-time code, the robot comes with it and a key of its own."""
