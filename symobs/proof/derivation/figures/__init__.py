"""Checks of figures: block diagrams, plots, root loci and time responses against the exact values (trusted)."""
