"""One fleet for days in minutes: the product's own service and the robots' own duties, by their real messages.

The service is `app.composition.Parts` with its workers and a real database; a robot's missions, claims, outbox and
connection are `robot.mission` and `robot.link`. Simulated are time (`loop.py`), the network (`network.py`), what a mind
decides (`robot.py`, `route.py`), bodies and what things take (`body.py`, `durations.py`), people and faults. Where
robots are is told by bodies alone (`judge.py`).
Start at `simulation.py`.
"""
