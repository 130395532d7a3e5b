"""Plants, and the readers of their data."""

from symobs.system.floats import read_floats
from symobs.system.matrices import Matrices
from symobs.system.other_programs import as_plant
from symobs.system.reading import read_complex, read_matrix, read_scalar
from symobs.system.state_space import StateSpace
from symobs.system.symbols import Symbols, is_sympy
from symobs.system.time_domain import Continuous, Discrete, TimeDomain
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
