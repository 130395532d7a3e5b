"""TODO symobs/analysis/time_response."""
