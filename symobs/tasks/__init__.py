"""Tasks: results, the analysis of plants, and designs for them."""
