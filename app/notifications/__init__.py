"""Notifications: written with the change itself, shown in the inbox, delivered by a worker.

May use accounts, realtime and core.
Start at `service.py`.
"""
