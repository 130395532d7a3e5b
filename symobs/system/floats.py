"""Floating-point numbers read as their shortest decimals, on request."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from fractions import Fraction
from math import isfinite
from typing import Any

from symobs.exact import Complex, Scalar
from symobs.ground.errors import InputError
from symobs.system.symbols import is_sympy


def read_floats(value: Any, floats: object, where: str) -> Any:
    """Return a value in which each float is the text of its shortest decimal; the value itself where there is none.

    Lists, tables, arrays, SymPy expressions and their floats are looked into.  `floats` is None, by which floats stay as they
    are and are refused by whoever reads them, or "decimal".  Raises `InputError` for another word, and where a number
    is not finite.
    """
    if floats is None:
        return value
    if not isinstance(floats, str) or floats != "decimal":
        message = f"{str(floats)[:40]!r} is no way to read floats"
        raise InputError(message, where="floats", repair='write floats="decimal", or leave it out')
    return _in_decimals(value, where)


def _in_decimals(value: Any, where: str) -> Any:
    if is_sympy(value):
        return _without_sympy_floats(value)
    if isinstance(value, Mapping):
        named = {name: _in_decimals(part, f"{where}.{name}") for name, part in value.items()}
        return value if all(named[name] is part for name, part in value.items()) else named
    is_array = type(value).__name__ in {"ndarray", "matrix"} and hasattr(value, "tolist")
    if is_array and value.shape == ():
        return _in_decimals(value[()], where)
    if isinstance(value, (list, tuple)) or is_array:
        entries = list(value if type(value).__name__ != "matrix" else value.A)
        read = [_in_decimals(entry, where) for entry in entries]
        return value if all(new is old for new, old in zip(read, entries, strict=True)) else read
    if isinstance(value, numbers.Real) and not isinstance(value, numbers.Rational):
        return _decimal(value, where)
    if isinstance(value, numbers.Complex) and not isinstance(value, numbers.Real):
        real, imaginary = (Scalar.of(Fraction(_decimal(part, where))) for part in (value.real, value.imag))
        return real if imaginary.is_zero else Complex(real, imaginary)
    return value


def _decimal(value: Any, where: str) -> str:
    """Return the shortest text that names the same float of its precision."""
    if not isfinite(value):
        raise InputError(f"{value} is not a finite number", where=where, repair="give finite numbers")
    return str(value)


def _without_sympy_floats(value: Any) -> Any:
    """Return a SymPy expression or matrix with each float of double precision as a fraction."""
    from symobs.exact.sympy_bridge.conversion import without_floats  # noqa: PLC0415 - SymPy is there already

    return without_floats(value)
