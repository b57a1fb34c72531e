"""Internal actions that read or change the agent: beliefs, plans, goals, intentions, events, namespaces.

Uses the tools of `builtin` and `builtin.terms`. Start with `beliefs`.
"""
