"""TODO symobs/figures."""
