"""TODO symobs/analysis/strata."""
