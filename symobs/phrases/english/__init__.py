"""TODO symobs/phrases/english."""
