"""Polynomial inequalities: their simplification, proofs of implication, and sample points."""
