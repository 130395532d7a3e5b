"""Facts a derivation may state besides equations: properties of matrices, rejected alternatives, restricted parameters."""
