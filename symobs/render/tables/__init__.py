"""TODO symobs/render/tables."""
