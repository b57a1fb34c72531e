"""Hand-overs as people see them: codes, taps, digits, delegates.

May use orders and robots; custody is written by robots' receipts alone.
Start at `service.py`.
"""
