"""Stability criteria: Liénard and Chipart, the Routh array, the Cauchy index, and critical polynomials."""
