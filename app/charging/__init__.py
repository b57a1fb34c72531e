"""Charging: sends idle robots to docks, and calls them away for work.

May use dispatch, robots and `fleet.charging`.
Start at `service.py`.
"""
