"""The devices of the robot, each behind one door (interfaces.py)."""
