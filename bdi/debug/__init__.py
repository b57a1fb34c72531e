"""Explanations of a running agent: trace entries, verdicts on each plan, and the reason why a goal is not reached.

Uses the packages below `reasoning` and only reads the agent. Start with `trace`, the entries that listeners receive.
"""
