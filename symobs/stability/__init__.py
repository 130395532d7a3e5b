"""Stability of polynomials with parameters: conditions, exact regions, and their proofs."""
