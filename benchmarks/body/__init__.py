"""Benchmarks of the body in the simulated world: python -m benchmarks.body --help."""
