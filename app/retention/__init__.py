"""Retention, backup, export and erasure of records.

May use orders and the models.
Start at `retention.py`.
"""
