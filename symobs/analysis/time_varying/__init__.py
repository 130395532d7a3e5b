"""TODO symobs/analysis/time_varying."""
