"""TODO symobs/phrases/english/page."""
