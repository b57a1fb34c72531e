"""Changes of an order that goes on: cancel, return, wait, pass on, intervene.

Each module is one kind of change and writes through the ledger.
Start at `cancelling.py`.
"""
