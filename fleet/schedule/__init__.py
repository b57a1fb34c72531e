"""Schedules in which every robot comes home, and their execution (docs/decisions/0048).

Imports nothing of the other planners.
Start at `controller.py`; `search.py` plans one robot, `validation.py` checks all.
"""
