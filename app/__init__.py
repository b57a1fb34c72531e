"""The service: stores orders, sends missions to robots, tells people.

It may use `fleet`, `maps` and `protocol`; never `robot` or `bdi`.
Start at `composition/parts.py`, which puts its parts together, then at the package of the feature.
"""
