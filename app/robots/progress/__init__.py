"""Consequences of robots' reports: stops, missions, receipts, faults.

One function per kind of report.
Start at `progress.py`: the table of reports.
"""
