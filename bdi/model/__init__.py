"""The parts that an agent consists of: beliefs, compiled formulas and plans, events, intentions, messages.

Uses `language` only. Start with `beliefs` and `intentions`; `mind` is the agent as internal actions see it.
"""
