"""Orders and robots as one person may see them.

Reads only.
Start at `views.py`.
"""
