"""TODO symobs/exact/cad."""
