"""Tables of notifications, preferences and delivery attempts.

Imported through `app.models`.
Start at `notifications.py`.
"""
