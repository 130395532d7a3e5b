"""TODO symobs/design/reduced_order."""
