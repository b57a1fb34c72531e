"""Step mode: a run shown cycle by cycle, forwards and backwards, with breakpoints.

Uses `tools.simulation`, recordings and what is below. Start with `stepper`, then `dialogue`.
"""
