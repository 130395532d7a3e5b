"""Scalars, matrices and polynomials over Q(parameters), on FLINT."""
