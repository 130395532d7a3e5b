"""Reference tracking and feedforward to a state feedback."""
