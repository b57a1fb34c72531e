"""How long the mind takes, beside other AgentSpeak interpreters: python -m benchmarks.mind --help."""
