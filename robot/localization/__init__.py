"""Localization: the place on the map, from markers, odometry and turns. Pure.

May use `maps` and the drivers' interfaces.
Start at `place.py`.
"""
