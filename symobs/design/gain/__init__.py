"""TODO symobs/design/gain."""
