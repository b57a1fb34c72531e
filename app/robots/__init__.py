"""Robots: enrolment, their sockets, what they report and are told.

May use orders, notifications, realtime and `fleet`.
Start at `service.py`, then `conversation/`: one robot's connection.
"""
