"""TODO symobs/audit/equations."""
