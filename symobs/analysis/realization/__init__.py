"""TODO symobs/analysis/realization."""
