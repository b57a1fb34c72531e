"""The state of the robots' links: connections, inbox, outbox, tokens and clocks.

Knows no feature beyond its tables.
Start at `outbox.py` and `inbox.py`: why no message is lost.
"""
