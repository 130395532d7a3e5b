"""TODO symobs/design/full_order."""
