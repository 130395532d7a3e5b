"""TODO symobs/stability/regions."""
