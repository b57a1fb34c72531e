"""The commands of `python -m bdi`: run, test, step through, check and replay agent programs without a body.

Uses all other packages and, alone among them, typer and rich. Start with `run`; each command is a module of its name.
"""
