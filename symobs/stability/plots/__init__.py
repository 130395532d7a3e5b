"""TODO symobs/stability/plots."""
