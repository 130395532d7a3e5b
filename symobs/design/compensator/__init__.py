"""TODO symobs/design/compensator."""
