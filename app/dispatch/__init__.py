"""Which robot carries what: a pure choice, and the loop that acts on it."""
