"""TODO symobs/stability/inequalities."""
