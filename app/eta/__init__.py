"""ETA records: durations learned from reports, promised windows, and their accuracy.

Its mathematics is in `fleet.eta`.
Start at `learning.py`.
"""
