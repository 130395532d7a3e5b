"""TODO symobs/render/formats."""
