"""Dispatch: which robot carries which order, and when it is expected.

May use robots, traffic, orders and `fleet.assignment`.
Start at `service.py`.
"""
