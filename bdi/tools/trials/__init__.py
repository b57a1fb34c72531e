"""Tests of agent programs: a script of inputs, the lines expected, and the differences.

Uses `tools.simulation` and what is below. Start with `scripts` (the format), then `runs`.
"""
