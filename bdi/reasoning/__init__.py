"""The reasoning cycle: perceive, process messages, select a plan, take one step.

Uses every package but `communication` and `tools`; knows no clock, thread or device. Start with `agent`.
"""
