"""Tables of people, sessions, tokens and contacts.

Imported through `app.models`.
Start at `people.py`.
"""
