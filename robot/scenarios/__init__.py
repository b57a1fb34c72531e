"""Scenarios: stories of robots and people, stepped and judged by true poses.

May use everything of the robot.
Start at `scenario.py`; `python -m robot.scenarios --help` runs them.
"""
