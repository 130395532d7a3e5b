"""The root locus of a loop."""
