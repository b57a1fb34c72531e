"""Actions of the agent: jobs that start skills and end done or failed.

May use skills and mission.
Start at `table.py`.
"""
