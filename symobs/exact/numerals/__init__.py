"""Decimals that are printed for exact numbers."""
