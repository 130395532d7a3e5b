"""Plants: ẋ = A x + B u, y = C x + D u, with exact entries.  Shapes and exactness are checked here and only here.

The time domain is a type, `Continuous` or `Discrete`.  Symbols carry declared signs; they stay with symobs, the SymPy
symbols a caller gets back are plain (or the caller's own objects).
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from symobs.conditions import SIGNS
from symobs.errors import InexactInput, InputError, ShapeMismatch, SymobsError
from symobs.exact import Complex, Field, Matrix, Scalar, companion
from symobs.expression import declared_name, parse_matrix, parse_scalar


@dataclass(frozen=True, slots=True)
class Continuous:
    """Continuous time: ẋ, the variable s, stability in the open left half plane."""

    variable = "s"


@dataclass(frozen=True, slots=True)
class Discrete:
    """Discrete time: x(k+1), the variable z, stability in the open unit disc; `period` if it is known."""

    period: Scalar | None = None
    variable = "z"


TimeDomain = Continuous | Discrete


@dataclass(frozen=True)
class Symbols:
    """The names a problem may use: their signs, how they are printed, the caller's own SymPy objects.

    `closed` means that only these names exist; otherwise every well-formed name is a real symbol.
    """

    signs: Mapping[str, str] = field(default_factory=dict)
    latex: Mapping[str, str] = field(default_factory=dict)
    objects: Mapping[str, Any] = field(default_factory=dict)
    closed: bool = False

    @property
    def names(self) -> Mapping[str, str] | None:
        """What the expression grammar accepts: the declared names, or None for any."""
        return self.signs if self.closed else None

    def sign(self, name: str) -> str:
        """Return a symbol's sign; undeclared ones are real."""
        return self.signs.get(name, "real")

    @staticmethod
    def of(declared: Mapping[str, Any] | None, where: str = "symbols") -> Symbols:
        """Read `{"omega": "positive", "b": {"sign": "positive", "latex": "b"}}`; None leaves the names open."""
        if declared is None:
            return Symbols()
        signs, latex, objects = {}, {}, {}
        for key, entry in declared.items():
            name = key if isinstance(key, str) else str(key)
            if not isinstance(key, str):
                objects[name] = key
            place = f"{where}.{name if len(name) <= 40 else name[:40] + '…'}"
            name = declared_name(name, place)
            details = entry if isinstance(entry, Mapping) else {"sign": entry}
            unknown = [str(k) for k in details if k not in {"sign", "latex"}]
            if unknown:
                message = f"unknown key {unknown[0]!r}"
                raise InputError(message, where=place, repair="use sign and latex")
            signs[name] = _sign(details.get("sign", "real"), place)
            if "latex" in details:
                latex[name] = _latex(details["latex"], f"{place}.latex")
        return Symbols(signs, latex, objects, closed=True)

    def seen(self, values: object) -> Symbols:
        """Return these symbols with those of SymPy objects in `values` added, their assumptions read as signs."""
        found = _sympy_symbols(values)
        if not found:
            return self
        from symobs.exact.sympy_border import sign_from_assumptions  # noqa: PLC0415 - SymPy only where it came in

        signs = {**{name: sign_from_assumptions(symbol) for name, symbol in found.items()}, **self.signs}
        return Symbols(signs, self.latex, {**found, **self.objects}, self.closed)


def _sign(entry: object, place: str) -> str:
    if entry not in SIGNS:
        message = f"{str(entry)[:40]!r} is not a sign"
        raise InputError(message, where=place, repair=f"write one of {', '.join(SIGNS)}")
    return str(entry)


_LATEX_LIMIT = 40


def _latex(entry: object, place: str) -> str:
    """Return a declared LaTeX form, which may be letters, digits, sub- and superscripts and named letters only."""
    allowed = isinstance(entry, str) and 0 < len(entry) <= _LATEX_LIMIT and _is_plain_latex(entry)
    if not allowed:
        message = f"{str(entry)[:40]!r} is not a printed form of a symbol"
        repair = "write letters and digits with ^, _, braces, or a named letter such as \\omega_0"
        raise InputError(message, where=place, repair=repair)
    return str(entry)


def _is_plain_latex(text: str) -> bool:
    import re  # noqa: PLC0415 - needed for declared forms only

    from symobs.notation import GREEK  # noqa: PLC0415

    named = {*GREEK, "varepsilon", "vartheta", "varphi", "ell", "mathrm", "mathit", "bar", "tilde", "dot", "hat"}
    commands = re.findall(r"\\([A-Za-z]+)", text)
    rest = re.sub(r"\\[A-Za-z]+", "", text)
    balanced = rest.count("{") == rest.count("}")
    return balanced and set(commands) <= named and re.fullmatch(r"[A-Za-z0-9_^{}', ]*", rest) is not None


def _sympy_symbols(values: object) -> dict[str, Any]:
    """Return the free SymPy symbols in a value, or in lists of values."""
    if isinstance(values, (list, tuple)):
        found: dict[str, Any] = {}
        for value in values:
            found |= _sympy_symbols(value)
        return found
    symbols = getattr(values, "free_symbols", None) if _is_sympy(values) else None
    return {str(symbol): symbol for symbol in sorted(symbols, key=str)} if symbols else {}


def _is_sympy(value: object) -> bool:
    return "sympy" in sys.modules and type(value).__module__.startswith("sympy")


def read_matrix(value: object, symbols: Symbols, where: str) -> Matrix:
    """Return the exact matrix of a text, nested lists (numbers, texts, SymPy expressions) or a SymPy matrix."""
    if isinstance(value, Matrix):
        return value
    if _is_sympy(value) and hasattr(value, "shape"):
        from symobs.exact.sympy_border import matrix_from_sympy  # noqa: PLC0415

        return matrix_from_sympy(value, where)
    if type(value).__module__.startswith("numpy"):
        value = _from_numpy(value, where)
    if isinstance(value, Sequence) and _sympy_symbols(value) | ({"": 0} if _any_sympy(value) else {}):
        return _mixed_rows(value, symbols, where)
    return parse_matrix(value, symbols.names, where=where)


def _any_sympy(value: object) -> bool:
    if isinstance(value, (list, tuple)):
        return any(_any_sympy(entry) for entry in value)
    return _is_sympy(value)


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
    if _is_sympy(value):
        from symobs.exact.sympy_border import scalar_from_sympy  # noqa: PLC0415

        return scalar_from_sympy(value, where)
    if isinstance(value, str):
        return parse_scalar(value, symbols.names, where=where)
    return parse_matrix([[value]], symbols.names, where=where)[0, 0]


def _from_numpy(value: Any, where: str) -> object:
    if getattr(value, "dtype", None) is not None and value.dtype.kind not in "iuO":
        message = f"a NumPy array of {value.dtype} holds floating-point numbers"
        raise InexactInput(message, where=where, repair='write exact values such as "1/10"')
    return value.tolist()


class StateSpace:
    """A linear time-invariant plant: ẋ = A x + B u, y = C x + D u (x(k+1) = … in discrete time).

    A  n×n, B  n×m, C  p×n, D  p×m; each a MATLAB-style text `"[0 1; 0 -1]"`, nested lists of integers and texts, or a
    SymPy matrix.  B, C may be left out where a task does not need them; D is zero if left out.
    dt       0 continuous time; True or a positive value: discrete time
    symbols  name → sign ("positive", …, "real"); when given, no other names exist

    Raises `ShapeMismatch`, `InexactInput` (floats), `ExpressionError`, `UnknownName`; all of them are `InputError`.
    """

    def __init__(
        self,
        A: object,
        B: object = None,
        C: object = None,
        D: object = None,
        dt: object = 0,
        *,
        symbols: Mapping[str, Any] | Symbols | None = None,
        transfer_function: Scalar | None = None,
    ) -> None:
        """Read the matrices and check that they fit."""
        known = symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)
        known = known.seen([A, B, C, D])
        errors: list[SymobsError] = []
        parts: dict[str, Matrix | None] = {}
        for name, value in (("A", A), ("B", B), ("C", C), ("D", D)):
            try:
                parts[name] = None if value is None else read_matrix(value, known, f"plant.{name}")
            except SymobsError as error:
                errors.append(error)
        if not errors:
            errors = _shape_errors(parts)
        if errors:
            _raise_all(errors)
        self.matrices = Matrices(parts["A"], parts["B"], parts["C"], parts["D"])  # type: ignore[arg-type]
        self.symbols = known
        self.time = read_time(dt, known)
        self.origin = transfer_function

    @classmethod
    def from_transfer_function(
        cls, transfer_function: object, dt: object = 0, *, symbols: Mapping[str, Any] | Symbols | None = None
    ) -> StateSpace:
        """Return the controllable canonical realisation of a proper rational function of s (z in discrete time).

        b(s)/a(s) + d with a(s) = sⁿ + a₁ sⁿ⁻¹ + … + aₙ gives ones above the diagonal, last row −aₙ … −a₁, B = eₙ and
        C the coefficients of b, constant first.  Raises `InputError` where the function is not proper or constant.
        """
        known = symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)
        known = known.seen(transfer_function)
        time = read_time(dt, known)
        where, variable = "plant.transfer_function", time.variable
        if isinstance(transfer_function, str):
            value = parse_scalar(transfer_function, known.names, variable=variable, where=where)
        else:
            value = read_scalar(transfer_function, known, where)
        A, B, C, D = realise(value, variable, where)
        return cls(A, B, C, D, dt, symbols=known, transfer_function=value)

    @classmethod
    def from_control(cls, system: Any, *, symbols: Mapping[str, Any] | None = None) -> StateSpace:
        """Return the plant of a python-control state-space system; each float is read as its shortest decimal."""
        rows = {name: [[repr(float(x)) for x in row] for row in getattr(system, name).tolist()] for name in "ABCD"}
        return cls(rows["A"], rows["B"], rows["C"], rows["D"], system.dt or 0, symbols=symbols)

    # -- what the kernel sees ----------------------------------------------------------------------------------------

    @property
    def order(self) -> int:
        """The number n of states."""
        return self.matrices.A.shape[0]

    @property
    def inputs(self) -> int:
        """The number m of inputs; 0 where B is not given."""
        return self.matrices.B.shape[1] if self.matrices.has_input else 0

    @property
    def outputs(self) -> int:
        """The number p of outputs; 0 where C is not given."""
        return self.matrices.C.shape[0] if self.matrices.has_output else 0

    @property
    def variable(self) -> str:
        """`s` in continuous, `z` in discrete time."""
        return self.time.variable

    @property
    def is_discrete(self) -> bool:
        """Whether time is discrete."""
        return isinstance(self.time, Discrete)

    @cached_property
    def field(self) -> Field:
        """Q(parameters of the plant)."""
        m = self.matrices
        return m.A.field | m.B.field | m.C.field | m.D.field

    def substitute(self, values: Mapping[str, Scalar]) -> StateSpace:
        """Return the plant with parameters replaced; raises ZeroDivisionError where it ceases to exist."""
        m = self.matrices
        B = m.B.substitute(values) if m.has_input else None
        C = m.C.substitute(values) if m.has_output else None
        D = m.D.substitute(values) if m.has_input and m.has_output else None
        replaced = StateSpace(m.A.substitute(values), B, C, D, symbols=self.symbols)
        replaced.time = self.time
        return replaced

    def require(self, *names: str, task: str) -> None:
        """Raise `InputError` unless the matrices a task uses are given."""
        missing = [n for n in names if (n == "B" and not self.inputs) or (n == "C" and not self.outputs)]
        if missing:
            message = f"{task} needs {' and '.join(missing)}"
            raise InputError(message, where="plant", repair=f'give {missing[0]}, for example {missing[0]} = "[0; 1]"')

    # -- the face ----------------------------------------------------------------------------------------------------

    def _face(self, name: str) -> Any:
        from symobs.exact.sympy_border import matrix_to_sympy  # noqa: PLC0415 - SymPy is the face only

        return matrix_to_sympy(getattr(self.matrices, name), self.symbols.objects)

    @property
    def A(self) -> Any:
        """The state matrix as a SymPy `ImmutableMatrix`."""
        return self._face("A")

    @property
    def B(self) -> Any:
        """The input matrix as a SymPy `ImmutableMatrix`."""
        return self._face("B")

    @property
    def C(self) -> Any:
        """The output matrix as a SymPy `ImmutableMatrix`."""
        return self._face("C")

    @property
    def D(self) -> Any:
        """The feedthrough matrix as a SymPy `ImmutableMatrix`."""
        return self._face("D")

    @property
    def dt(self) -> Any:
        """0 in continuous time, True or the period in discrete time."""
        if isinstance(self.time, Continuous):
            return 0
        return True if self.time.period is None else self.time.period.fraction()

    def __repr__(self) -> str:
        m = self.matrices
        shown = [f"A={m.A}"] + [f"{n}={getattr(m, n)}" for n in "BC" if getattr(m, n).entries]
        return f"StateSpace({', '.join(shown)}, dt={self.dt})"


class Matrices:
    """The four exact matrices of a plant; a missing one has no columns (B) or no rows (C)."""

    def __init__(self, A: Matrix, B: Matrix | None, C: Matrix | None, D: Matrix | None) -> None:
        """Fill in what is missing: D is zero."""
        order = A.shape[0]
        self.A = A
        self.B = Matrix.zeros(order, 0) if B is None else B
        self.C = Matrix.zeros(0, order) if C is None else C
        self.D = Matrix.zeros(self.C.shape[0], self.B.shape[1]) if D is None else D
        self.has_input, self.has_output = B is not None, C is not None

    @property
    def has_feedthrough(self) -> bool:
        """Whether D is not zero."""
        return not self.D.is_zero


def realise(value: Scalar, variable: str, where: str = "transfer_function") -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return the controllable canonical form (A, B, C, D) of a proper rational function."""
    denominator = value.denominator.coefficients(variable)
    order = len(denominator) - 1
    numerator = value.numerator.coefficients(variable)
    if order < 1:
        message = f"{value} has no pole, so it has no state"
        raise InputError(message, where=where, repair="give a proper rational function such as 1/(s*(s+1))")
    if len(numerator) > order + 1:
        message = f"{value} is not proper: degree {len(numerator) - 1} over degree {order}"
        raise InputError(message, where=where, repair="the degree of the numerator may not exceed the denominator's")
    lead = denominator[0]
    monic = [c / lead for c in denominator[1:]]
    padded = [Scalar.of(0)] * (order + 1 - len(numerator)) + [c / lead for c in numerator]
    feedthrough = padded[0]
    rest = [b - feedthrough * a for a, b in zip(monic, padded[1:], strict=True)]
    return (
        companion(monic),
        Matrix.unit(order, order - 1),
        Matrix.row(list(reversed(rest))),
        Matrix.of([[feedthrough]]),
    )


def read_time(dt: object, symbols: Symbols) -> TimeDomain:
    """Return the time domain that `dt` names: 0 continuous, True or a positive value discrete."""
    if dt is True:
        return Discrete()
    if dt is False or dt is None or dt == 0:
        return Continuous()
    value = read_scalar(str(dt) if isinstance(dt, float) else dt, symbols, "plant.dt")
    if value.is_zero:
        return Continuous()
    if not value.is_constant or value.fraction() <= 0:
        message = f"{value} is not a sampling period"
        raise InputError(message, where="plant.dt", repair="write 0 for continuous time, true or a positive number")
    return Discrete(value)


def _shape_errors(parts: Mapping[str, Matrix | None]) -> list[SymobsError]:
    A, B, C, D = parts["A"], parts["B"], parts["C"], parts["D"]
    errors: list[SymobsError] = []

    def expect(name: str, wanted: str, came: Matrix) -> None:
        message = f"{name} is {came.shape[0]}×{came.shape[1]}, expected {wanted}"
        errors.append(ShapeMismatch(message, where=f"plant.{name}", repair=f"give {name} with {wanted.split(',', maxsplit=1)[0]}"))

    if A is None:
        return [InputError("A is missing", where="plant.A", repair='give the state matrix, for example "[0 1; 0 -1]"')]
    order = A.shape[0]
    if order == 0 or A.shape[1] != order:
        expect("A", "a square matrix", A)
        return errors
    if B is not None and (B.shape[0] != order or B.shape[1] == 0):
        expect("B", f"{order} rows, one for each state", B)
    if C is not None and (C.shape[1] != order or C.shape[0] == 0):
        expect("C", f"{order} columns, one for each state", C)
    if D is not None and not errors:
        rows, columns = (C.shape[0] if C is not None else 0), (B.shape[1] if B is not None else 0)
        if D.shape != (rows, columns):
            expect("D", f"{rows}×{columns}, outputs by inputs", D)
    return errors


def _raise_all(errors: Sequence[SymobsError]) -> None:
    """Raise one error as it is, several together."""
    from symobs.errors import ProblemErrors  # noqa: PLC0415

    raise errors[0] if len(errors) == 1 else ProblemErrors(tuple(errors))


def read_complex(value: object, symbols: Symbols, where: str) -> Complex:
    """Return the exact complex number of a SymPy expression."""
    from symobs.exact.sympy_border import complex_from_sympy  # noqa: PLC0415

    return complex_from_sympy(value, where)
