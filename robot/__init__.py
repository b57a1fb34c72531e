"""The robot's daemon: drives, finds its way, carries mail, talks to the service.

It may use `bdi`, `maps` and `protocol`; never `app` or `fleet`.
Start at `ops/assembly.py`, which puts a robot together, then at `drive_loop/loop.py`.
"""
