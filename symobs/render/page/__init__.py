"""TODO symobs/render/page."""
