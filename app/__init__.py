"""The service: stores orders, sends missions to robots, tells people.

It may use `fleet`, `maps` and `protocol`; never `robot` or `bdi`.
Start at `main.py`, which composes its parts, then at the package of the feature.
"""
