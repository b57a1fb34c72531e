"""The paper's evaluation again, its own program beside ours: python -m benchmarks.paper --help."""
