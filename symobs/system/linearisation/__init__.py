"""Nonlinear plants, linearised at an equilibrium."""
