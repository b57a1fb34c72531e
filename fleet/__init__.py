"""The planning engine of a fleet: schedule, assignment, charging and ETA.

Pure: depends on `maps` alone. Time is an argument; it reads no clock, file or database.
Start at `schedule/controller.py`, then `assignment/deciding.py`.
"""
