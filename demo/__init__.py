"""The demonstrations: service and robots in processes of their own, and people who send letters.

Sits above `app`; starts `robot` as a process. Simulated throughout.
Start at `run.py` and `fleet/run.py`.
"""
