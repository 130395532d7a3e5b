"""Plants from systems of python-control, SciPy and SymPy, and from lists of coefficients."""

from __future__ import annotations

from typing import Any

from symobs.ground.errors import InputError
from symobs.system.state_space import StateSpace
from symobs.system.symbols import is_sympy

_MAKE_ONE = 'give a symobs.StateSpace, for example symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")'


def as_plant(value: Any, *, only: bool = True, floats: str | None = None) -> Any:
    """Return the plant of a result, of a system of python-control, SciPy or SymPy, or of a pair of lists of coefficients.

    A `StateSpace` is returned as it is, and what is no plant where it need not be the `only` thing that may come: raises
    `InputError` otherwise, saying how to make one.  A list of two lists of one length may be meant as a matrix: a
    numerator and a denominator come as a tuple.
    """
    if isinstance(value, StateSpace):
        return value
    if (there := getattr(value, "as_plant", None)) is not None:  # the result of a task
        return there
    module = str(type(value).__module__)
    if module.partition(".")[0] == "control":
        return StateSpace.from_control(value)
    if module.startswith("sympy.physics.control"):
        return _from_sympy(value, floats)
    if module.startswith("scipy.signal"):
        return _from_scipy(value)
    if isinstance(value, list) and value and all(map(_is_flat, value)) and len({*map(len, value)}) == 1:
        message = "a list of rows is no plant: it may be a matrix, or a numerator and a denominator"
        repair = "give symobs.StateSpace(A, B, C) for the matrix A, or the tuple ([1, 2], [1, 3]) for (s + 2)/(s + 3)"
        raise InputError(message, where="plant", repair=repair)
    if isinstance(value, (list, tuple)) and len(value) == 2 and all(map(_is_flat, value)):
        return StateSpace.from_transfer_function(value, floats=floats)
    if not only:
        return value
    repair = _MAKE_ONE
    if isinstance(value, str) or is_sympy(value):
        repair += ', or symobs.StateSpace.from_transfer_function("1/(s*(s+1))")'
    message = f"a plant is expected, but a value of type {type(value).__name__} came"
    raise InputError(message, where="plant", repair=repair)


def _is_flat(part: object) -> bool:
    """Return whether this is a list or an array of numbers."""
    return isinstance(part, (list, tuple)) or len(getattr(part, "shape", ())) == 1


def _from_scipy(system: Any) -> StateSpace:
    """Return the plant of a linear system of `scipy.signal`; each float is read as its shortest decimal."""
    dt = (repr(system.dt) if isinstance(system.dt, float) else system.dt) or 0
    if all(hasattr(system, name) for name in "ABCD"):
        plant = StateSpace(system.A, system.B, system.C, system.D, dt, floats="decimal")
    elif hasattr(system, "num"):
        pair = (system.num.tolist(), system.den.tolist())
        plant = StateSpace.from_transfer_function(pair, dt, floats="decimal")
    else:
        message = (
            f"a state-space system or a transfer function of SciPy is expected, but a {type(system).__name__} came"
        )
        raise InputError(message, where="plant", repair="convert it by system.to_tf() or system.to_ss()")
    plant.is_from_floats = True
    return plant


def _from_sympy(system: Any, floats: str | None) -> StateSpace:
    """Return the plant of a system of `sympy.physics.control`, connections of systems included."""
    found = system.doit()
    dt = getattr(found, "sampling_time", 0)
    if all(hasattr(found, name) for name in "ABCD"):
        return StateSpace(found.A, found.B, found.C, found.D, dt, floats=floats)
    if hasattr(found, "num_inputs") and not hasattr(found, "num"):
        entries = [[found[i, j].doit() for j in range(found.num_inputs)] for i in range(found.num_outputs)]
    else:
        entries = [[found]]
    if not all(hasattr(entry, name) for row in entries for entry in row for name in ("num", "den", "var")):
        message = f"a state-space system or transfer functions of SymPy are expected, but a {type(found).__name__} came"
        raise InputError(message, where="plant", repair=_MAKE_ONE)
    from symobs.exact.sympy_bridge.conversion import with_plain_symbols  # noqa: PLC0415 - SymPy is there already

    variable = "z" if dt else "s"
    rows = [
        [tuple(with_plain_symbols(part, {entry.var: variable}) for part in (entry.num, entry.den)) for entry in row]
        for row in entries
    ]
    single = rows[0][0] if len(rows) == len(rows[0]) == 1 else rows
    return StateSpace.from_transfer_function(single, dt, floats=floats)
