"""Internal actions that reach outside: messages, other agents, printing, time and chance.

Uses the tools of `builtin` and `builtin.terms`. Start with `messages`.
"""
