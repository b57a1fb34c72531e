"""Dispatch where every corridor is granted at once: the nearest free robot.

A comparison for benchmarks and small tests, see docs/decisions/0085.
Start at `nearest.py`.
"""
