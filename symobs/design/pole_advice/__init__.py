"""TODO symobs/design/pole_advice."""
