"""TODO symobs/analysis/rank."""
