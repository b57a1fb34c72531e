"""Corridors as the database has them: reservations, closures, and who occupies which.

Knows no planner; `app.traffic` decides who may enter.
Start at `reservations.py`.
"""
