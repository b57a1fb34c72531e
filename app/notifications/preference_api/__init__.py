"""Preferences over HTTP: muted kinds, browsers, webhooks.

May use the channels, to try one.
Start at `routes.py`.
"""
