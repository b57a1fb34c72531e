"""Operation of a robot: assembly, daemon, commands, doctor, calibration, diagnostics.

May use everything of the robot.
Start at `assembly.py` and `daemon.py`.
"""
