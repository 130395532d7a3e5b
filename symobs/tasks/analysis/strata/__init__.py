"""Strata of the parameters: where ranks drop and eigenvalues coincide."""
