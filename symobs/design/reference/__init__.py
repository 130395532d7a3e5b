"""TODO symobs/design/reference."""
