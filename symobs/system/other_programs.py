"""Plants from systems of python-control, SciPy and SymPy, and from lists of coefficients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import Matrix, Scalar
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.system.state_space import StateSpace, read_floats
from symobs.system.symbols import is_sympy

if TYPE_CHECKING:
    from collections.abc import Sequence

_MAKE_ONE = 'give a symobs.StateSpace, for example symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")'


def as_plant(value: Any, *, only: bool = True, floats: str | None = None) -> Any:
    """Return the plant of a result, of a system of python-control, SciPy or SymPy, or of a pair of lists of coefficients.

    The keywords of `symobs.linearize` are a plant whose equilibria can be asked for.  A `StateSpace` is returned as it is,
    and what is no plant where it need not be the `only` thing that may come: raises `InputError` otherwise, saying how to
    make one.  A list of two lists of one length may be meant as a matrix: a numerator and a denominator come as a tuple.
    """
    if isinstance(value, StateSpace):
        return value
    if isinstance(value, Mapping) and {"f", "equations", "kinetic"} & value.keys():
        from symobs.system.linearize import without_equilibrium  # noqa: PLC0415 - of such plants alone

        return without_equilibrium(**value)
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


# Systems of SymPy, whose connections are made here: of three state-space systems in series SymPy leaves the third out.


def _from_sympy(system: Any, floats: str | None) -> StateSpace:
    """Return the plant of a system of `sympy.physics.control`, connections of systems included.

    What comes of a connection is held against the parts, each evaluated by SymPy at a point.
    """
    found = _part(system, floats)
    plant = found if isinstance(found, StateSpace) else _of_functions(found, floats)
    if _KINDS.get(type(system).__name__) is not None:
        _require_the_same(system, plant, floats)
    return plant


@dataclass
class _Functions:
    """Rows of transfer functions, each (numerator, denominator), their variable and the period."""

    rows: list[list[tuple[Any, Any]]]
    variable: Any
    dt: Any

    @property
    def is_one(self) -> bool:
        """Whether there is one input and one output."""
        return len(self.rows) == len(self.rows[0]) == 1


#: A system as a plant, or by its transfer functions.
_Part: TypeAlias = StateSpace | _Functions

_KINDS = {
    "Series": "series",
    "MIMOSeries": "series",
    "Parallel": "parallel",
    "MIMOParallel": "parallel",
    "Feedback": "feedback",
    "MIMOFeedback": "feedback",
}


def _part(system: Any, floats: str | None) -> _Part:
    """Return a system as a plant if there is a state-space system in it, else by its transfer functions."""
    if (kind := _KINDS.get(type(system).__name__)) is None:
        return _single(system, floats)
    if kind == "feedback":
        return _fed_back(_part(system.sys1, floats), _part(system.sys2, floats), int(system.sign), floats)
    join = _in_series if kind == "series" else _in_parallel
    return reduce(
        lambda before, part: join(before, _part(part, floats), floats), system.args[1:], _part(system.args[0], floats)
    )


def _single(system: Any, floats: str | None) -> _Part:
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
    return _Functions([[(entry.num, entry.den) for entry in row] for row in entries], entries[0][0].var, dt)


def _of_functions(found: _Functions, floats: str | None) -> StateSpace:
    """Return the plant of transfer functions."""
    from symobs.exact.sympy_bridge.conversion import with_plain_symbols  # noqa: PLC0415 - SymPy is there already

    variable = "z" if found.dt else "s"
    rows = [
        [tuple(with_plain_symbols(part, {found.variable: variable}) for part in entry) for entry in row]
        for row in found.rows
    ]
    single = rows[0][0] if found.is_one else rows
    return StateSpace.from_transfer_function(single, found.dt, floats=floats)


def _as_factor(part: _Part, floats: str | None) -> Any:
    """Return a plant, or the gain of one transfer function without a pole."""
    if isinstance(part, StateSpace):
        return part
    gains = [[above / below for above, below in row] for row in part.rows]
    if any(part.variable in gain.free_symbols for row in gains for gain in row):
        return _of_functions(part, floats)
    return gains[0][0] if part.is_one else gains


def _in_series(first: _Part, second: _Part, floats: str | None) -> _Part:
    """Return second · first."""
    if not (isinstance(first, _Functions) and isinstance(second, _Functions)):
        left, right = _as_factor(second, floats), _as_factor(first, floats)
        return left * right  # type: ignore[no-any-return]
    if first.is_one and second.is_one:
        (above, below), (further, beneath) = first.rows[0][0], second.rows[0][0]
        return replace(first, rows=[[(above * further, below * beneath)]])
    columns = [*zip(*first.rows, strict=True)]
    rows = [
        [_sum([(a * c, b * d) for (a, b), (c, d) in zip(row, column, strict=True)]) for column in columns]
        for row in second.rows
    ]
    return replace(first, rows=_in_lowest_terms(rows))


def _in_parallel(first: _Part, second: _Part, floats: str | None) -> _Part:
    """Return first + second."""
    if not (isinstance(first, _Functions) and isinstance(second, _Functions)):
        return _as_factor(first, floats) + _as_factor(second, floats)  # type: ignore[no-any-return]
    rows = [[_sum(pair) for pair in zip(*both, strict=True)] for both in zip(first.rows, second.rows, strict=True)]
    return replace(first, rows=rows if first.is_one else _in_lowest_terms(rows))


def _fed_back(first: _Part, second: _Part, sign: int, floats: str | None) -> _Part:
    """Return (I − sign first · second)⁻¹ first."""
    if isinstance(first, _Functions) and isinstance(second, _Functions) and first.is_one and second.is_one:
        (above, below), (further, beneath) = first.rows[0][0], second.rows[0][0]
        return replace(first, rows=[[(above * beneath, below * beneath - sign * above * further)]])
    forward = first if isinstance(first, StateSpace) else _of_functions(first, floats)
    return forward.feedback(_as_factor(second, floats), sign)


def _sum(functions: Sequence[tuple[Any, Any]]) -> tuple[Any, Any]:
    """Return a sum of functions over the product of their different denominators."""
    (above, below), *others = functions
    for further, beneath in others:
        above, below = (
            (above + further, below) if below == beneath else (above * beneath + further * below, below * beneath)
        )
    return above, below


def _in_lowest_terms(rows: list[list[tuple[Any, Any]]]) -> list[list[tuple[Any, Any]]]:
    return [[(above / below).cancel().as_numer_denom() for above, below in row] for row in rows]


# The check: the connection at a point, of the parts that SymPy has.


#: A point at which no plant of a book has a pole.
_POINT = Scalar.rational(1009, 97)


def _require_the_same(system: Any, plant: StateSpace, floats: str | None) -> None:
    """Raise `CertificateRejected` where a plant has another value at a point than the connection of SymPy's parts."""
    m, one = plant.matrices, Matrix.identity(plant.order)
    found = m.C @ (one * _POINT - m.A).inverse() @ m.B + m.D
    if not (found - _at_point(system, floats)).normal().is_zero:
        raise CertificateRejected("the connection of SymPy's systems has another value at a point than its parts")


def _at_point(system: Any, floats: str | None) -> Matrix:
    """Return the value of a system at the point, connection by connection."""
    from symobs.exact.sympy_bridge.conversion import scalar_from_sympy, with_plain_symbols  # noqa: PLC0415 - as above

    kind = _KINDS.get(type(system).__name__)
    if kind == "feedback":
        first, second = (_at_point(part, floats) for part in (system.sys1, system.sys2))
        inside = Matrix.identity(first.shape[0]) - first @ second * int(system.sign)
        return inside.inverse() @ first
    if kind is not None:
        values = [_at_point(part, floats) for part in system.args]
        return reduce(lambda before, value: value @ before if kind == "series" else before + value, values)
    part = _single(system, floats)
    if isinstance(part, StateSpace):
        m = part.matrices
        return m.C @ (Matrix.identity(part.order) * _POINT - m.A).inverse() @ m.B + m.D

    def at(expression: Any) -> Scalar:
        plain = with_plain_symbols(read_floats(expression, floats, "plant"), {part.variable: "s"})
        return scalar_from_sympy(plain, "plant", roots=True).substitute({"s": _POINT})

    return Matrix.of([[at(above) / at(below) for above, below in row] for row in part.rows])
