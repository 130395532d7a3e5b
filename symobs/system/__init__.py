"""Plants, and the readers of their data."""

from symobs.system.other_programs import as_plant
from symobs.system.reading import Continuous, Discrete, Matrices, TimeDomain, read_complex, read_matrix, read_scalar
from symobs.system.state_space import StateSpace, read_floats
from symobs.system.symbols import Symbols, is_sympy
from symobs.system.transfer_function_text import realise

__all__ = [
    "Continuous",
    "Discrete",
    "Matrices",
    "StateSpace",
    "Symbols",
    "TimeDomain",
    "as_plant",
    "is_sympy",
    "read_complex",
    "read_floats",
    "read_matrix",
    "read_scalar",
    "realise",
]
