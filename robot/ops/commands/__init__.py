"""The maintainer's commands: one module for each command of `python -m robot`. Only these print."""
