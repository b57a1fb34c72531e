"""The service's commands: one file per noun. `python -m app --help` is their table of contents."""
