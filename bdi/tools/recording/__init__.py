"""Recorded runs: written to a file, and run again with the same program, chance and inputs.

Uses `communication` and what is below. Start with `recorder`, then `replaying`.
"""
