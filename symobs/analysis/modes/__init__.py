"""TODO symobs/analysis/modes."""
