"""Exact values from texts, nested lists, SymPy and NumPy objects; floats are refused."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from symobs.errors import InexactInput, ShapeMismatch
from symobs.exact import Complex, Matrix, Scalar
from symobs.expression import parse_matrix, parse_scalar
from symobs.system.symbols import Symbols, is_sympy, sympy_symbols

_DECIMAL = re.compile(r"\d\.\d")


def has_decimals(value: object) -> bool:
    """Return whether a text, or nested lists of texts, contain a decimal number."""
    if isinstance(value, (list, tuple)):
        return any(has_decimals(entry) for entry in value)
    return _DECIMAL.search(str(value)) is not None if isinstance(value, str) else False


def read_matrix(value: object, symbols: Symbols, where: str, beside: Sequence[object] = ()) -> Matrix:
    """Return the exact matrix of a text, nested lists (numbers, texts, SymPy expressions) or a SymPy matrix.

    That of a text stands in one context with the matrices of the texts `beside` it.
    """
    if isinstance(value, Matrix):
        return value
    if isinstance(value, str):
        return parse_matrix(value, symbols.names, where=where, beside=beside)
    if is_sympy(value) and hasattr(value, "shape"):
        from symobs.exact.sympy_bridge.conversion import matrix_from_sympy  # noqa: PLC0415

        return matrix_from_sympy(value, where)
    if type(value).__module__.startswith("numpy"):
        value = _from_numpy(value, where)
    if isinstance(value, Sequence) and sympy_symbols(value) | ({"": 0} if _any_sympy(value) else {}):
        return _mixed_rows(value, symbols, where)
    return parse_matrix(value, symbols.names, where=where)


def _any_sympy(value: object) -> bool:
    if isinstance(value, (list, tuple)):
        return any(_any_sympy(entry) for entry in value)
    return is_sympy(value)


def _mixed_rows(value: Sequence[Any], symbols: Symbols, where: str) -> Matrix:
    rows = [list(row) if isinstance(row, (list, tuple)) else [row] for row in value]
    lengths = {len(row) for row in rows}
    if len(lengths) > 1:
        message = f"rows of different lengths {sorted(lengths)}"
        raise ShapeMismatch(message, where=where, repair="give every row the same number of entries")
    return Matrix.of(
        [
            [read_scalar(entry, symbols, f"{where}[{i}][{j}]") for j, entry in enumerate(row)]
            for i, row in enumerate(rows)
        ]
    )


def read_scalar(value: object, symbols: Symbols, where: str) -> Scalar:
    """Return the exact scalar of a number, a text or a SymPy expression."""
    if isinstance(value, Scalar):
        return value
    if is_sympy(value):
        from symobs.exact.sympy_bridge.conversion import scalar_from_sympy  # noqa: PLC0415

        return scalar_from_sympy(value, where)
    return parse_scalar(value, symbols.names, where=where)


def _from_numpy(value: Any, where: str) -> object:
    if getattr(value, "dtype", None) is not None and value.dtype.kind not in "iuO":
        message = f"a NumPy array of {value.dtype} holds floating-point numbers"
        raise InexactInput(message, where=where, repair='write exact values such as "1/10"')
    return value.tolist()


def read_complex(value: object, where: str) -> Complex:
    """Return the exact complex number of a SymPy expression."""
    from symobs.exact.sympy_bridge.conversion import complex_from_sympy  # noqa: PLC0415

    return complex_from_sympy(value, where)
