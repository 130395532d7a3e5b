"""TODO symobs/exact/algebraic."""
