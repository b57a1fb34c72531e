"""Device drivers: base, line sensor, camera, serial port.

May use `robot.core`; knows no skill and no mission.
Start at `interfaces.py`.
"""
