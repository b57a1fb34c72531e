"""Whole robots in one simulated world, with the product's whole service, in stepped time.

Every robot is the daemon as it ships (agent, skills, reflexes, drivers) with a simulated body; all bodies meet in one
world. The service is `benchmarks.fleet_simulation.service`. The judge sees the bodies' true poses alone.
Start at `run.py`.
"""
