"""TODO symobs/derivation/facts."""
