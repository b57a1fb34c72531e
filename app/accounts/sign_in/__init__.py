"""Signing in: mailed codes and the campus's own provider (OpenID Connect).

May use the sessions and tokens of `app.accounts`.
Start at `service.py`.
"""
