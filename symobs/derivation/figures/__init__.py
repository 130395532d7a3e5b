"""TODO symobs/derivation/figures."""
