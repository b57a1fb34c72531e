"""The doctor, `python -m robot doctor`: checks for faults of a robot, each with its remedy.

May use settings, drivers and equipment.
Start at `table.py`.
"""
