"""Stability regions and root loci as plots."""
