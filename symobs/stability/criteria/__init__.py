"""TODO symobs/stability/criteria."""
