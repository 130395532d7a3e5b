"""TODO symobs/render/plots."""
