"""TODO symobs/phrases/english/stability."""
