"""What a maintainer types: one module for each command of `python -m robot`. Only these print."""
