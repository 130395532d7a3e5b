"""TODO symobs/phrases/english/design."""
