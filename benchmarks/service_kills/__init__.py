"""SIGKILL of the real service at random moments under load, and the audit of what it has kept and told."""
