"""TODO symobs/phrases/english/analysis."""
