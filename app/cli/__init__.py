"""The service's commands: one file per noun.

May use everything of the service.
Start at `output.py`; `python -m app --help` lists the commands.
"""
