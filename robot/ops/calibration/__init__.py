"""Calibration: measures wheel scale and spacing, the diodes, and the camera of one robot.

May use the assembly and the drivers.
Start at `rig.py`.
"""
