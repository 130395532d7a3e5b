"""Polynomial ideals by Gröbner bases."""
