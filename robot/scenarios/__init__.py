"""Scenarios: a simulated world with robots, people, mail and trouble in a file; run, judged by the truth, replayed."""
