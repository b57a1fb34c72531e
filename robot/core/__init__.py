"""The foundation of the daemon: settings, errors, files, sockets, logs.

Imports no other package of the robot.
Start at `config.py`.
"""
