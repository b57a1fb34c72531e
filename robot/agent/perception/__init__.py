"""Percepts: what the agent is shown of body and mission.

May use the mission's state.
Start at `percepts.py`.
"""
