"""Orders: one item from a sender to a recipient, from the form to the hand-over."""
