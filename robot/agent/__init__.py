"""The agent: its AgentSpeak programs, percepts, actions, and the loop around the mind.

May use skills, mission and localization.
Start at `main.asl` and `mind.py`.
"""
