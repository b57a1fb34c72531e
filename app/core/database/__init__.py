"""The database: transactions, shared commits, drivers and the schema's version.

Imports nothing of the features; `app.models` has the tables.
Start at `database.py`.
"""
