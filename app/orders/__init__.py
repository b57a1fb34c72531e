"""The life of an order, from the form to the hand-over.

May use accounts, notifications, realtime and the ETA records; knows no robot link.
Start at `transitions.py`, then `ledger.py`: the only place that changes an order's state.
"""
