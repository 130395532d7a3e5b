"""Signals: functions of the time t, one for each component."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.formula.expression import parse_matrix
from symobs.ground.errors import ShapeMismatch
from symobs.system import is_sympy, read_matrix

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.system import StateSpace, Symbols


def read_signal(value: object, plant: StateSpace, name: str, size: int, *, functions: bool = False) -> Matrix:
    """Return a signal of `size` components: rational in t, or with `functions` also in exp, sin, …; raises `ShapeMismatch`."""
    where = f"specification.{name}"
    signal = parse_signal(value, plant.symbols, where, functions=functions)
    signal = signal.T if signal.shape == (1, size) else signal
    if signal.shape != (size, 1):
        message = f"{name} has {signal.shape[0]}×{signal.shape[1]} entries, expected a column of {size}"
        raise ShapeMismatch(message, where=where, repair=f"write {size} entries, set apart by semicolons")
    return signal


def parse_signal(value: object, symbols: Symbols, where: str, *, functions: bool = False) -> Matrix:
    """Return the entries of a signal, of any number."""
    listed = value if isinstance(value, (str, list, tuple)) or hasattr(value, "shape") else [[value]]
    known = symbols.seen(value, "t").with_time()
    if not functions:
        return read_matrix(listed, known, where)
    rows: Any = listed.tolist() if hasattr(listed, "tolist") else listed
    if not isinstance(rows, str):
        rows = [[_text(entry) for entry in (row if isinstance(row, (list, tuple)) else [row])] for row in rows]
    return parse_matrix(rows, known.names, where=where, functions=True)


def _text(entry: object) -> object:
    """Return a SymPy expression as text: the grammar reads its functions."""
    if not is_sympy(entry):
        return entry
    from symobs.exact.sympy_bridge.conversion import with_plain_symbols  # noqa: PLC0415 - SymPy is there already

    return str(with_plain_symbols(entry))
