"""Plants and what they are read from."""

from symobs.system.foreign import as_plant
from symobs.system.fraction import realise
from symobs.system.plant import Matrices, StateSpace
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
    "as_plant",
    "is_sympy",
    "read_complex",
    "read_matrix",
    "read_scalar",
    "realise",
]
