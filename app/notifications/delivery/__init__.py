"""Delivery of notifications: which are due, attempts, and the worker.

May use the channels.
Start at `worker.py`.
"""
