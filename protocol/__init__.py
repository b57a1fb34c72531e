"""Messages between service and robot: one frozen class per message, and the clock they agree on."""
