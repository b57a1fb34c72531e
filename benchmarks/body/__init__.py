"""What the body can do, in the simulated world: python -m benchmarks.body --help."""
