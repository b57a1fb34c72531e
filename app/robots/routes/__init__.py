"""Robots over HTTP: their socket, lists, commands, diagnostics.

Handlers of a few lines; the work is in `app.robots`.
Start at `robots.py`.
"""
