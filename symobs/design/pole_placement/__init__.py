"""TODO symobs/design/pole_placement."""
