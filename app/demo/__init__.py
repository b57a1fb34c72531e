"""The demonstration: service and robot in processes of their own, and two simulated people who send one letter."""
