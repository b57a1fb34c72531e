"""The foundation of every feature: settings, errors, database, logs, clock, texts and mail.

Imports no other package of the service.
Start at `settings.py` and `database/database.py`.
"""
