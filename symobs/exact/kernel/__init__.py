"""TODO symobs/exact/kernel."""
