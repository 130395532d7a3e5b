"""Plots of regions, root loci and time responses: their layout, and a writer for each format."""
