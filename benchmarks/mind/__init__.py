"""The speed of the mind, beside other AgentSpeak interpreters: python -m benchmarks.mind --help."""
