"""TODO symobs/analysis/stability_region."""
