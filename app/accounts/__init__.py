"""People: accounts, roles, tokens, contacts and rate limits.

May use `app.core` and `app.models`.
Start at `current_user.py`: how a route learns who asks.
"""
