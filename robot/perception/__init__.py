"""What the mind believes of the world: signals become symbols, each on its own and with its own age."""
