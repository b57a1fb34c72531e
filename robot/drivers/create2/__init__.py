"""The iRobot Create 2: its Open Interface, modes, odometry and sleep.

May use the serial drivers.
Start at `create2.py`; `open_interface.py` has the manual's tables.
"""
