"""Algebraic numbers: roots of polynomials, certified enclosures, and decimals."""
