"""TODO symobs/exact/sympy_bridge."""
