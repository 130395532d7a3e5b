"""Observer-based compensators of full and of minimal order, and their pages."""
