"""Drawings: block diagrams and plots, laid out once as a `Scene`, and its writers."""
