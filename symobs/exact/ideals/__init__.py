"""TODO symobs/exact/ideals."""
