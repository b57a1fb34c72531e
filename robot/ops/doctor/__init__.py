"""What is wrong with a robot, and the way out: `python -m robot doctor`. Small checks, one table."""
