"""Conversion to and from SymPy, the only import of SymPy."""
