"""From the agent's actions to the body: what each one takes, what it starts, and how it ends by name."""
