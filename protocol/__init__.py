"""What server and robot say to each other: one frozen class per message, and the clock they agree on."""
