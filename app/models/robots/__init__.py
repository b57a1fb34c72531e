"""Tables of robots: missions, messages, reservations, commands, samples.

Imported through `app.models`.
Start at `robots.py`.
"""
