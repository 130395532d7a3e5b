"""Formulas as MathML Core."""
