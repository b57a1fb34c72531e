"""The simulated base: a Create 2 as its manual describes it, byte by byte.

Knows nothing of the floor beyond its world's interfaces.
Start at `drive_base.py`.
"""
