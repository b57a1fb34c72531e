"""The commands of `python -m bdi`: run, test, step through, check and replay agent programs without a body."""
