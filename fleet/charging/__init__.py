"""Charge as a limit of work: what it costs, who may take it, who charges when.

Imports nothing of the other planners.
Start at `going_on.py`, then `docks.py`.
"""
