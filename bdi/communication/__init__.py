"""Several agents in one process: mailboxes, the directory of services, agents created and killed at run time.

Uses `reasoning` and what is below. Start with `system`.
"""
