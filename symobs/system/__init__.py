"""Plants and what they are read from."""

from symobs.system.matrices import Matrices
from symobs.system.plant import StateSpace, realise
from symobs.system.reading import read_complex, read_matrix, read_scalar
from symobs.system.symbols import Symbols, is_sympy
from symobs.system.time import Continuous, Discrete, TimeDomain

__all__ = [
    "Continuous",
    "Discrete",
    "Matrices",
    "StateSpace",
    "Symbols",
    "TimeDomain",
    "is_sympy",
    "read_complex",
    "read_matrix",
    "read_scalar",
    "realise",
]
