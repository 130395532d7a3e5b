"""Cylindrical algebraic decomposition of the plane, and its check."""
