"""Plants: ẋ = A x + B u, y = C x + D u, with exact entries.  Shapes and exactness are checked here and only here."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from copy import copy
from fractions import Fraction
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from symobs.exact import Complex, Field, Ideal, Matrix, Scalar, apart_from_zero, companion, modulo
from symobs.exact.core.generators import NotWritten, substitute, symbols_in
from symobs.exact.floating.sampled import nearest_double
from symobs.exact.numerals.written_digits import in_digits
from symobs.ground.errors import InputError, SymobsError, raise_all
from symobs.system.conditions import Condition, sign_of
from symobs.system.findings import Findings
from symobs.system.reading import (
    Continuous,
    Discrete,
    Matrices,
    TimeVarying,
    as_rows,
    has_decimals,
    inserted,
    over_a_base,
    read_matrix,
    read_time,
    read_values,
    shape_errors,
)
from symobs.system.symbols import Symbols, is_sympy
from symobs.system.transfer_function_text import WrittenTransferFunction, read_characteristic
from symobs.system.transfer_matrix import WrittenTransferMatrix, connected, inverse_of, read_written

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from symobs.system.reading import Nonlinear


# State-space and transfer-function systems of python-control.


class ControlSystem(NamedTuple):
    """The data of a system: rows of numerators over denominators, or else the matrices by name; dt is 0 in continuous time."""

    transfer_function: list[list[Any]] | None
    matrices: dict[str, Any]
    dt: Any


def read_control_system(system: Any) -> ControlSystem:
    """Return the data of a python-control system.

    Raises `InputError` where the system has no A, B, C, D and no numerator and denominator of numbers.
    """
    dt = (repr(system.dt) if isinstance(system.dt, float) else system.dt) or 0 if hasattr(system, "dt") else 0
    if hasattr(system, "num") and hasattr(system, "den"):
        try:
            rows = [
                [[above.tolist(), below.tolist()] for above, below in zip(*row, strict=True)]
                for row in zip(system.num, system.den, strict=True)
            ]
        except (AttributeError, TypeError) as error:
            message = f"a system of python-control is expected, but a {type(system).__name__} came"
            raise InputError(message, where="plant", repair="give what control.ss or control.tf returns") from error
        return ControlSystem(rows[0][0] if len(rows) == len(rows[0]) == 1 else rows, {}, dt)
    for name in "ABCD":
        if getattr(getattr(system, name, None), "dtype", None) is None or getattr(system, name).dtype.kind not in "iuf":
            message = (
                f"a python-control state-space system is expected, {type(system).__name__} has no matrix of numbers "
                f"{name}"
            )
            raise InputError(message, where=f"plant.{name}", repair="convert it by control.ss(system)")
    return ControlSystem(None, {name: getattr(system, name) for name in "ABCD"}, dt)


def exact_of(system: Any) -> Any:
    """Return the exact plant that a system was made of, None where there is none or its floats are others by now."""
    exact = getattr(system, "exact", None)
    if exact is None or not all(_are_of(getattr(exact.matrices, name), getattr(system, name)) for name in "ABCD"):
        return None
    return exact if (exact.dt if isinstance(exact.dt, int) else float(exact.dt)) == system.dt else None


def _are_of(matrix: Matrix, array: Any) -> bool:
    """Return whether an array holds the doubles nearest to the entries of an exact matrix."""
    return bool(array.shape == matrix.shape) and array.reshape(-1).tolist() == [*map(nearest_double, matrix.entries)]


# Floating-point numbers read as their shortest decimals, on request.


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


#: Equations of more terms than this cost no more: where they are long, what they leave is mostly few points.
_LONG = 25


class StateSpace:
    """A linear plant: ẋ = A x + B u, y = C x + D u (x(k+1) = … in discrete time).

    A  n×n, B  n×m, C  p×n, D  p×m; each a MATLAB-style text `"[0 1; 0 -1]"`, nested lists of exact numbers and texts, a
    SymPy matrix or a NumPy array; flat lists are a column B and a row C.  B, C may be left out where a task does not
    need them; D is zero if left out.
    dt       0 continuous time; True or a positive value: discrete time
    symbols  name → sign ("positive", …, "real"); when given, no other names exist
    floats   "decimal" reads floats as their shortest decimals, and the page says so; otherwise they are refused

    The name t is the time: a plant with t in a matrix is time-varying, ẋ = A(t) x + B(t) u, and need not declare it.
    `P * Q`, `P + Q` and `P.feedback(Q)` connect plants as python-control does; Q may be a gain.
    Raises `ShapeMismatch`, `InexactInput` (floats), `ExpressionError`, `UnknownName`; all of them are `InputError`.
    """

    #: Whether irrational data were rounded.
    is_rounded = False
    #: What is positive where the plant is: an equilibrium may be there for some parameters alone.
    positive: tuple[Scalar, ...] = ()

    def __init__(
        self,
        A: object,
        B: object = None,
        C: object = None,
        D: object = None,
        dt: object = 0,
        *,
        symbols: Mapping[str, Any] | Symbols | None = None,
        floats: str | None = None,
        transfer_function: WrittenTransferFunction | WrittenTransferMatrix | None = None,
    ) -> None:
        """Read the matrices and check that they fit."""
        known = symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)
        came = A, B, C, D
        A, B, C, D = (read_floats(value, floats, f"plant.{name}") for name, value in zip("ABCD", came, strict=True))
        self.is_from_floats = any(new is not old for new, old in zip((A, B, C, D), came, strict=True))
        known = known.seen([A, B, C, D])
        A, B, C, D = (as_rows(name, value) for name, value in zip("ABCD", (A, B, C, D), strict=True))
        named, texts = known.with_time(), [value for value in (A, B, C, D) if isinstance(value, str)]
        errors: list[SymobsError] = []
        parts: dict[str, Matrix | None] = {}
        for name, value in (("A", A), ("B", B), ("C", C), ("D", D)):
            try:
                place = f"plant.{name}"
                first = parts.get("A")
                if isinstance(value, str) and value.strip() == "I" and "I" not in known.signs and first is not None:
                    parts[name] = Matrix.identity(first.shape[0])
                    continue
                parts[name] = None if value is None else read_matrix(value, named, place, texts, functions=True)
            except SymobsError as error:
                errors.append(error)
        if parts.get("D") == Matrix.zeros(1, 1):
            parts["D"] = None
        rows, column = parts.get("A"), parts.get("B")
        if rows is not None and column is not None and column.shape == (1, rows.shape[0]):
            parts["B"] = column.T  # it is written as a row
        if "A" in parts:
            errors += shape_errors({name: parts.get(name) for name in "ABC"} | {"D": None if errors else parts["D"]})
        raise_all(errors)
        parts, relations = over_a_base(parts, known.signs, in_time=True)
        self.matrices = Matrices(parts["A"], parts["B"], parts["C"], parts["D"])  # type: ignore[arg-type]
        self.symbols = known
        self.time = read_time(dt, known)
        self.written = transfer_function
        self.polynomial: Scalar | None = None
        self.nonlinear: Nonlinear | None = None
        self.is_in_decimals = any(has_decimals(value) for value in (A, B, C, D))
        self.equations: tuple[Scalar, ...] = ()
        self.nonzero: tuple[Scalar, ...] = ()
        self.is_stratum = False
        #: The plant with parameters whose values these are: what was a case of its results is a result, no refusal.
        self.general: StateSpace | None = None
        given = [part for part in parts.values() if part is not None]
        known.refuse_alike({*known.signs}.union(*(part.names for part in given)), "symbols")
        if any("t" in symbols_in(part) for part in given):
            self._let_vary()
        given = [part for part in given if self.variable in part.field.position]
        clash = self.variable in known.signs or any(self.variable in part.names for part in given)
        if clash and not self.is_time_varying:
            message = f"{self.variable} is the variable of the polynomials and cannot be a parameter of the plant"
            raise InputError(message, where="plant", repair="give the parameter another name")
        there = self.restricted(relations)
        self.matrices, self.equations = there.matrices, there.equations

    @classmethod
    def from_transfer_function(
        cls,
        transfer_function: object,
        *given: object,
        dt: object = 0,
        symbols: Mapping[str, Any] | Symbols | None = None,
        floats: str | None = None,
        realisation: str | None = None,
    ) -> StateSpace:
        """Return the controllable canonical realisation of a proper rational function of s (z in discrete time).

        b(s)/a(s) + d with a(s) = sⁿ + a₁ sⁿ⁻¹ + … + aₙ gives ones above the diagonal, last row −aₙ … −a₁, B = eₙ and
        C the coefficients of b, constant first.  `realisation` may be "observable", (Aᵀ, Cᵀ, Bᵀ), or "modal", A block
        diagonal, B with a 1 in each block and C with the residues.  The function is a text, a SymPy expression or lists of
        coefficients, highest power first: ([1], [1, 2, 0]), or [1], [1, 2, 0]; dt may stand behind.  A matrix of functions,
        "[1/(s+1) 0; 1/s 1/(s+1)]", or ([[1, 0], [1, 1]], [1, 1]) with a common denominator, is given a minimal realisation.
        Raises `InputError` where a function is not proper, or has no pole.
        """
        if given and (isinstance(given[0], (list, tuple)) or hasattr(given[0], "tolist")):
            transfer_function, given = (transfer_function, given[0]), given[1:]
        if len(given) > 1:
            message = f"{len(given)} values stand behind the transfer function"
            raise InputError(message, where="plant.transfer_function", repair="give it, and dt")
        (dt,) = given or (dt,)
        known = symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)
        time, where = read_time(dt, known), "plant.transfer_function"
        exact = read_floats(transfer_function, floats, where)
        known = known.seen(exact, time.variable)
        written = read_written(exact, known, time.variable, where, realisation)
        A, B, C, D = written.realised(where, known.signs)
        plant = cls(A, B, C, D, dt, symbols=known, transfer_function=written)
        plant.is_from_floats, plant.is_in_decimals = exact is not transfer_function, has_decimals(exact)
        return plant

    @classmethod
    def from_polynomial(
        cls, polynomial: object, dt: object = 0, *, symbols: Mapping[str, Any] | Symbols | None = None
    ) -> StateSpace:
        """Return ẋ = A x with A the companion matrix of a polynomial of s (z in discrete time), divided by its lead.

        Raises `InputError` where it is no polynomial of degree 1 or more.
        """
        known = symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)
        time = read_time(dt, known)
        known = known.seen(polynomial, time.variable)
        value = read_characteristic(polynomial, known, time.variable, "specification.polynomial")
        lead, *rest = value.coefficients(time.variable)
        plant = cls(companion([c / lead for c in rest]), dt=dt, symbols=known)
        plant.polynomial, plant.is_in_decimals = value, has_decimals(polynomial)
        return plant

    @classmethod
    def from_control(cls, system: Any, *, symbols: Mapping[str, Any] | None = None) -> StateSpace:
        """Return the plant of a python-control system; each float is read as its shortest decimal.

        The page says so; what `Result.to_control` made is read back exactly.  Raises `InputError` for other objects.
        """
        if symbols is None and (exact := exact_of(system)) is not None:
            return cast("StateSpace", exact)
        transfer_function, matrices, dt = read_control_system(system)
        if transfer_function is None:
            plant = cls(**matrices, dt=dt, symbols=symbols, floats="decimal")
        else:
            plant = cls.from_transfer_function(transfer_function, dt, symbols=symbols, floats="decimal")
        plant.is_from_floats = True
        return plant

    # -- what the kernel sees ----------------------------------------------------------------------------------------

    @property
    def order(self) -> int:
        """The number n of states."""
        return self.matrices.A.shape[0]

    @property
    def inputs(self) -> int:
        """The number m of inputs; 0 where B is not given."""
        return self.matrices.B.shape[1]

    @property
    def outputs(self) -> int:
        """The number p of outputs; 0 where C is not given."""
        return self.matrices.C.shape[0]

    @property
    def variable(self) -> str:
        """`s` in continuous, `z` in discrete time."""
        return self.time.variable

    @property
    def is_discrete(self) -> bool:
        """Whether time is discrete."""
        return isinstance(self.time, Discrete)

    @property
    def is_time_varying(self) -> bool:
        """Whether the matrices may contain the time t."""
        return isinstance(self.time, TimeVarying)

    def _let_vary(self) -> None:
        """Declare t as the time; raises `InputError` in discrete time."""
        if self.is_discrete or self.origin is not None:
            message = "t is the time, and " + (
                "in discrete time no matrix may contain it" if self.is_discrete else "a transfer function has none"
            )
            raise InputError(message, where="plant", repair="give the parameter another name")
        self.time = TimeVarying()

    def in_time(self) -> StateSpace:
        """Return the same plant as one whose matrices may contain t; raises `InputError` in discrete time."""
        if self.is_time_varying:
            return self
        if self.is_discrete:
            repair = "leave dt out: a time-varying plant is in continuous time"
            raise InputError("the plant is given in discrete time", where="plant.dt", repair=repair)
        m = self.matrices
        plant = StateSpace(m.A, m.B if m.has_input else None, m.C if m.has_output else None, symbols=self.symbols)
        plant.matrices, plant.time, plant.is_from_floats = m, TimeVarying(), self.is_from_floats
        plant.equations, plant.nonzero = self.equations, self.nonzero
        return plant

    @property
    def origin(self) -> Scalar | Matrix | None:
        """The transfer function, or matrix, in lowest terms, if the plant was given by one."""
        return None if self.written is None else self.written.value

    @property
    def apart(self) -> tuple[Scalar, ...]:
        """Denominators of the data in the parameters that cancel in every entry of the matrices."""
        return () if self.written is None else self.written.apart

    @cached_property
    def field(self) -> Field:
        """Q(parameters of the plant)."""
        m = self.matrices
        return m.A.field | m.B.field | m.C.field | m.D.field

    def substitute(self, values: Mapping[Any, Any]) -> StateSpace:
        """Return the plant with parameters replaced: {"c": "1/2"}, or SymPy symbols and what an entry may be.

        Raises `InputError` for what is no parameter or cannot have the value, ZeroDivisionError where no plant is left.
        """
        m, symbols = self.matrices, self.symbols.seen(list(values.values()))
        read = read_values(values, symbols, {*m.symbols, *symbols.signs})
        values = read if all(isinstance(value, Scalar) for value in values.values()) else inserted(read)
        try:
            A, *others = (substitute(part, values) for part in (m.A, m.B, m.C, m.D))
        except NotWritten as error:
            raise InputError(str(error), where="plant", repair="give another value") from None
        there = m.has_input, m.has_output, m.has_input and m.has_output
        B, C, D = [part if is_there else None for part, is_there in zip(others, there, strict=True)]
        period = getattr(self.time, "period", None)
        plant = StateSpace(A, B, C, D, self.dt if period is None else str(substitute(period, values)), symbols=symbols)
        images = [substitute(equation, values).numerator for equation in self.equations]
        nonzero = [substitute(value, values).numerator for value in self.nonzero]
        if any(value.is_zero for value in nonzero) or any(i.is_constant and not i.is_zero for i in images):
            raise ZeroDivisionError("what does not vanish is 0")
        return plant.restricted([image for image in images if not image.is_zero], nonzero)

    def in_coordinates(
        self, A: Matrix, B: Matrix | None, C: Matrix | None, D: Matrix | None, nonzero: Iterable[Scalar]
    ) -> StateSpace:
        """Return a plant with other matrices over the same parameters, which there is where some values do not vanish."""
        plant = copy(self)
        plant.__dict__.pop("field", None)
        plant.matrices = Matrices(A, B, C, D if B is not None and C is not None else None)
        plant.written = plant.polynomial = plant.nonlinear = None
        plant.nonzero = tuple(dict.fromkeys((*self.nonzero, *self.apart, *(value.numerator for value in nonzero))))
        return plant.asked_anew()

    def in_digits(self) -> StateSpace:
        """Return the plant with its irrational numbers rounded, which a page says; itself where it has none, or letters."""
        m = self.matrices
        if self.polynomial is not None or self.is_time_varying:
            return self
        A, B, C, D = map(in_digits, (m.A, m.B, m.C, m.D))
        if A is None or B is None or C is None or D is None or (A, B, C, D) == (m.A, m.B, m.C, m.D):
            return self
        rounded = self.in_coordinates(A, B if m.has_input else None, C if m.has_output else None, D, ())
        return rounded.with_rounding()

    def with_rounding(self) -> StateSpace:
        """Return the plant of a page that says of its data that they are rounded, and is written in decimals."""
        plant = copy(self)
        plant.is_rounded = plant.is_in_decimals = True
        return plant

    def restricted(self, equations: Iterable[Scalar], nonzero: Iterable[Scalar] = ()) -> StateSpace:
        """Return the plant where some polynomials, which must have common zeros, vanish and others do not."""
        ideal, apart = Ideal.of((*self.equations, *equations)), tuple(dict.fromkeys((*self.nonzero, *nonzero)))
        if not ideal.generators and apart == self.nonzero:
            return self
        m, plant = self.matrices, copy(self)
        plant.__dict__.pop("field", None)
        plant.matrices = Matrices(
            modulo(m.A, ideal),
            modulo(m.B, ideal) if m.has_input else None,
            modulo(m.C, ideal) if m.has_output else None,
            modulo(m.D, ideal),
        )
        plant.equations, plant.nonzero = ideal.generators, apart
        return plant

    def simplified(self, value: Scalar) -> Scalar:
        """Return a value simplified modulo the relations between the parameters."""
        return self.ideal.simplified(value) if self.ideal is not None else value

    def admits(self, value: Scalar | Matrix) -> bool:
        """Return whether a value is defined here: its denominator does not vanish modulo the relations."""
        return self.ideal is None or value.common_denominator() not in self.ideal

    @property
    def ideal(self) -> Ideal | None:
        """The ideal of the relations, None if there are none."""
        return Ideal.of(self.equations) if self.equations else None

    @property
    def exists_where(self) -> tuple[Condition, ...]:
        """That its equilibrium is there, where the declared signs do not say so."""
        signs = self.symbols.signs
        return tuple(Condition("domain", v, ">") for v in self.positive if sign_of(v, signs) != "positive")

    @property
    def relations(self) -> tuple[Scalar, ...]:
        """What vanishes on a stratum: the equations, and 1 − w p for each p that does not vanish; else nothing."""
        return (*self.equations, *map(apart_from_zero, self.nonzero)) if self.equations else ()

    def knowing(self, *values: object) -> StateSpace:
        """Return the plant with the caller's SymPy symbols in `values`: their signs, and the objects to return."""
        return self.with_symbols(self.symbols.seen(list(values), self.variable))

    def with_symbols(self, symbols: Symbols) -> StateSpace:
        """Return the same plant with these symbols."""
        if symbols is self.symbols:
            return self
        plant = copy(self)
        plant.symbols = symbols
        return plant

    def __mul__(self, other: object) -> StateSpace:
        """Return the series connection y = P₁ P₂ u: the other plant comes first."""
        return connected("series", self, other)

    def __rmul__(self, other: object) -> StateSpace:
        """Return y = K P u for a number or a matrix K."""
        return connected("gain", self, other)

    def __neg__(self) -> StateSpace:
        """Return y = −P u."""
        return connected("gain", self, -1)

    def __truediv__(self, other: object) -> StateSpace:
        """Return y = P u/k for a number k; raises `InputError` for 0 and for a matrix."""
        return connected("gain", self, inverse_of(self, other))

    def __pow__(self, exponent: object) -> StateSpace:
        """Return y = Pᵏ u, the series connection of k plants; raises `InputError` unless k is a positive integer."""
        if isinstance(exponent, bool) or not isinstance(exponent, int) or exponent < 1:
            raise InputError(f"{exponent!r} is no number of plants", where="plant", repair="write P**2, P**3, …")
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __add__(self, other: object) -> StateSpace:
        """Return the parallel connection y = (P₁ + P₂) u."""
        return connected("parallel", self, other)

    __radd__ = __add__
    #: NumPy's arrays leave the products with them to the plant.
    __array_ufunc__ = None

    def __sub__(self, other: object) -> StateSpace:
        """Return y = (P₁ − P₂) u."""
        return self + -other if isinstance(other, StateSpace) else -(-self + other)

    def __rsub__(self, other: object) -> StateSpace:
        """Return y = (K − P) u."""
        return -self + other

    def feedback(self, other: object = 1, sign: int = -1) -> StateSpace:
        """Return y = (I − sign P₁ P₂)⁻¹ P₁ u, P₂ a plant or a gain in the feedback path."""
        return connected("feedback" if sign < 0 else "positive feedback", self, other)

    @cached_property
    def findings(self) -> Findings:
        """What was found on the strata of this plant, and on those that it is a stratum of."""
        return Findings()

    def stratum(self, there: StateSpace) -> StateSpace:
        """Return the plant on a stratum, one object for each stratum, with shared findings."""
        if there is self:
            return self
        there.is_stratum, there.findings = True, self.findings
        return cast("StateSpace", self.findings.same(there))

    def beside(self, plant: StateSpace) -> StateSpace:
        """Return another plant derived from this one, with shared findings."""
        plant.is_stratum, plant.findings = self.is_stratum, self.findings
        return plant

    def once(self, question: tuple[Any, ...], find: Callable[[], Any]) -> Any:
        """Return the answer of a question about this plant; on a stratum what was found there once."""
        if not self.is_stratum:
            return find()
        cost = 1 + min(_LONG, sum(equation.size for equation in self.equations))
        return self.findings.once((question, self), cost, find)

    def asked_anew(self) -> StateSpace:
        """Return the same plant with empty findings, which are freed with the result."""
        return copy(self)

    def __getstate__(self) -> dict[str, Any]:
        """Return what makes the plant; what was found on its strata is no part of that."""
        return {name: value for name, value in vars(self).items() if name != "findings"}

    def pair_asked_for(self, of: str) -> str:
        """Return observability or controllability where `of` leaves it to the data: of (A, B) without C it is the latter."""
        by_input = self.matrices.has_input and not self.matrices.has_output
        return of if of != "auto" else "controllability" if by_input else "observability"

    def require(self, *names: str, task: str) -> None:
        """Raise `InputError` unless the matrices of a task are given."""
        missing = [n for n in names if (n == "B" and not self.inputs) or (n == "C" and not self.outputs)]
        if missing:
            message = f"{task} needs {' and '.join(missing)}"
            example = f'{missing[0]} = "{"[0; 1]" if missing[0] == "B" else "[1 0]"}"'
            raise InputError(message, where=f"plant.{missing[0]}", repair=f"give it, for example {example}")

    # -- the face ----------------------------------------------------------------------------------------------------

    def _face(self, name: str) -> Any:
        from symobs.exact.sympy_bridge.conversion import matrix_to_sympy  # noqa: PLC0415 - SymPy is the face only

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
        """0 in continuous time, True or the period in discrete time, a text where it is a symbol."""
        if isinstance(self.time, Continuous):
            return 0
        period = self.time.period
        return True if period is None else period.fraction() if period.is_constant else str(period)

    def __eq__(self, other: object) -> bool:
        """Return whether entries, time, symbols (with signs and printed forms) and the form of the data are equal."""
        return self._value == other._value if isinstance(other, StateSpace) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.matrices)

    @property
    def _value(self) -> tuple[object, ...]:
        signs = {name: sign for name, sign in self.symbols.signs.items() if sign != "real"}
        given = self.origin, self.polynomial, self.nonlinear, self.is_from_floats, self.is_in_decimals
        return (self.matrices, self.time, signs, self.symbols.latex, given, self.equations, self.nonzero)

    def _repr_latex_(self) -> str:
        """Return the equations of state and output for a notebook."""
        m = self.matrices
        there = {"A": True, "B": m.has_input, "C": m.has_output, "D": m.has_feedthrough}
        written = {
            name: getattr(self, name)._repr_latex_().removeprefix("$\\displaystyle ").removesuffix("$")
            for name, is_there in there.items()
            if is_there
        }

        def terms(*pairs: tuple[str, str]) -> str:
            return " + ".join(f"{written[name]} {signal}" for name, signal in pairs if name in written)

        next_state, x, u, y = ("x(k+1)", "x(k)", "u(k)", "y(k)") if self.is_discrete else (r"\dot{x}", "x", "u", "y")
        output = rf",\qquad {y} = {terms(('C', x), ('D', u))}" if "C" in written else ""
        return rf"$\displaystyle {next_state} = {terms(('A', x), ('B', u))}{output}$"

    def __repr__(self) -> str:
        m = self.matrices
        shown = [f"A={m.A}"] + [f"{n}={getattr(m, n)}" for n in "BC" if getattr(m, n).entries]
        return f"StateSpace({', '.join(shown)}, dt={self.dt})"
