"""TODO symobs/exact/time_functions."""
