"""The mission aboard: mail, custody, reservations, memory and outbox on disk.

May use `robot.core`; knows no socket.
Start at `mission.py`, then `memory.py`.
"""
