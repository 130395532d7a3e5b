"""TODO symobs/certificate."""
