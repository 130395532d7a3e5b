"""Plants from systems of python-control and SymPy, and from lists of coefficients."""

from __future__ import annotations

from typing import Any

from symobs.errors import InputError
from symobs.exact import Scalar
from symobs.system.state_space import StateSpace
from symobs.system.symbols import is_sympy

_MAKE_ONE = 'give a symobs.StateSpace, for example symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")'


def as_plant(value: Any, *, only: bool = True) -> Any:
    """Return the plant of a system of python-control or SymPy, or of a pair of lists of coefficients.

    A `StateSpace` is returned as it is, and what is no plant where it need not be the `only` thing that may come: raises
    `InputError` otherwise, saying how to make one.
    """
    if isinstance(value, StateSpace):
        return value
    module = type(value).__module__
    if module.partition(".")[0] == "control":
        return StateSpace.from_control(value)
    if module.startswith("sympy.physics.control"):
        return _from_sympy(value)
    if isinstance(value, (list, tuple)) and len(value) == 2 and all(isinstance(part, (list, tuple)) for part in value):
        return StateSpace.from_transfer_function(value)
    if not only:
        return value
    repair = _MAKE_ONE
    if isinstance(value, str) or is_sympy(value):
        repair += ', or symobs.StateSpace.from_transfer_function("1/(s*(s+1))")'
    message = f"a plant is expected, but a value of type {type(value).__name__} came"
    raise InputError(message, where="plant", repair=repair)


def _from_sympy(system: Any) -> StateSpace:
    """Return the plant of a system of `sympy.physics.control`, connections of systems included."""
    found = system.doit()
    dt = getattr(found, "sampling_time", 0)
    if all(hasattr(found, name) for name in "ABCD"):
        return StateSpace(found.A, found.B, found.C, found.D, dt)
    if not all(hasattr(found, name) for name in ("num", "den", "var")):
        message = f"a system of SymPy with one input and one output is expected, but a {type(found).__name__} came"
        raise InputError(message, where="plant", repair=_MAKE_ONE)
    from symobs.exact.sympy_bridge.conversion import scalar_to_sympy  # noqa: PLC0415 - SymPy is imported only on demand

    variable = Scalar.symbol("z" if dt else "s")
    own = {found.var: scalar_to_sympy(variable)}
    coefficients = (found.num.subs(own), found.den.subs(own))
    return StateSpace.from_transfer_function(coefficients, dt)
