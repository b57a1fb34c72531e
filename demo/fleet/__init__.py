"""The demonstration of a fleet: simulated robots in the Carleton tunnels, and a stream of orders.

May use the parts of `demo`.
Start at `run.py`.
"""
