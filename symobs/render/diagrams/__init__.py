"""TODO symobs/render/diagrams."""
