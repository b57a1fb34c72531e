"""The actors of a scenario: robots, people, the service's stand-in.

May use the scenario and its campus.
Start at `actors.py`.
"""
