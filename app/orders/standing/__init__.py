"""Standing orders: when they recur, and how each occurrence becomes one order.

May use `placing`.
Start at `standing.py`.
"""
