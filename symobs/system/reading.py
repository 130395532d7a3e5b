"""Exact values from texts, nested lists, SymPy and NumPy objects; floats are refused."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from decimal import Decimal
from functools import lru_cache
from math import lcm, prod
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Ideal, Matrix, Scalar
from symobs.exact.algebraic.real_algebraic import RealRoot
from symobs.exact.core.generators import (
    KINDS,
    Function,
    NotWritten,
    all_roots,
    are_dependent,
    derivative,
    function_named,
    functions_in,
    identities,
    substitute,
    symbols_in,
)
from symobs.formula.expression import parse_matrix, parse_scalar, without_latex
from symobs.formula.expression.parse import FLOATS
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InexactInput, InputError, ShapeMismatch, SymobsError
from symobs.system.conditions import sign_of
from symobs.system.symbols import Symbols, is_sympy, sympy_symbols

if TYPE_CHECKING:
    from symobs.system.motion import Motion

#: Signs that a value cannot have whose parameter is declared with another.
_EXCLUDED = {
    "positive": ("negative", "nonpositive", "zero"),
    "negative": ("positive", "nonnegative", "zero"),
    "nonnegative": ("negative",),
    "nonpositive": ("positive",),
    "nonzero": ("zero",),
}


_DECIMAL = re.compile(r"\.\d|(?<![A-Za-z_\d])\d+[eE]-\d")


def has_decimals(value: object) -> bool:
    """Return whether a text, or nested lists and tables of texts and numbers, contain a decimal number."""
    if isinstance(value, Decimal):
        return value.is_finite() and value != value.to_integral_value()
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        return any(has_decimals(entry) for entry in value)
    return _DECIMAL.search(str(value)) is not None if isinstance(value, str) else False


def read_matrix(
    value: object,
    symbols: Symbols,
    where: str,
    beside: Sequence[object] = (),
    *,
    variable: str | None = None,
    functions: bool = False,
) -> Matrix:
    """Return the exact matrix of a text, nested lists (numbers, texts, SymPy expressions) or a SymPy matrix.

    That of a text stands in one context with the matrices of the texts `beside` it.  With `functions`, functions of
    parameters are read as generators, and of the variable k powers, too.
    """
    if isinstance(value, Matrix):
        return value
    if isinstance(value, str):
        return parse_matrix(value, symbols.names, variable=variable, where=where, beside=beside, functions=functions)
    if is_sympy(value) and hasattr(value, "tolist") and len(getattr(value, "shape", ())) == 2:
        from symobs.exact.sympy_bridge.conversion import matrix_from_sympy  # noqa: PLC0415

        return matrix_from_sympy(value, where, roots=functions)
    if str(type(value).__module__).startswith("numpy"):
        value = _from_numpy(value, where)
    if isinstance(value, Sequence) and sympy_symbols(value) | ({"": 0} if _any_sympy(value) else {}):
        return _mixed_rows(value, symbols, where, functions=functions)
    return parse_matrix(value, symbols.names, variable=variable, where=where, functions=functions)


def _any_sympy(value: object) -> bool:
    if isinstance(value, (list, tuple)):
        return any(_any_sympy(entry) for entry in value)
    return is_sympy(value)


def _mixed_rows(value: Sequence[Any], symbols: Symbols, where: str, *, functions: bool) -> Matrix:
    rows = [list(row) if isinstance(row, (list, tuple)) else [row] for row in value]
    lengths = {len(row) for row in rows}
    if len(lengths) > 1:
        message = f"rows of different lengths {sorted(lengths)}"
        raise ShapeMismatch(message, where=where, repair="give every row the same number of entries")
    return Matrix.of(
        [
            [read_scalar(entry, symbols, f"{where}[{i}][{j}]", functions=functions) for j, entry in enumerate(row)]
            for i, row in enumerate(rows)
        ]
    )


def read_scalar(
    value: object, symbols: Symbols, where: str, *, functions: bool = False, nonlinear: bool = False
) -> Scalar:
    """Return the exact scalar of a number, a text or a SymPy expression; `functions` and `nonlinear` as for a matrix."""
    if isinstance(value, Scalar):
        return value
    if is_sympy(value):
        from symobs.exact.sympy_bridge.conversion import scalar_from_sympy  # noqa: PLC0415

        return scalar_from_sympy(value, where, roots=functions)
    return parse_scalar(value, symbols.names, where=where, functions=functions, nonlinear=nonlinear)


def read_values(
    values: Mapping[Any, Any], symbols: Symbols, names: Collection[str], *, nonlinear: bool = False
) -> dict[str, Scalar]:
    """Return the values that parameters, given by their names or as SymPy symbols, are to have.

    Raises `InputError` for what is none of the names, and for a value that the declared sign of its parameter excludes.
    """
    read: dict[str, Scalar] = {}
    for key, value in values.items():
        name = str(getattr(key, "name", key))
        where = f"substitute.{shown(name, 40)}"
        if name not in names and not isinstance(value, Scalar):  # our own values are of generators, too
            known = f"use {', '.join(sorted(names))}" if names else f"it has none: leave {shown(name, 40)} out"
            raise InputError(f"{shown(name, 40)} is no parameter of the plant", where=where, repair=known)
        read[name] = read_scalar(value, symbols, where, functions=True, nonlinear=nonlinear)
        sign = symbols.sign(name)
        if not isinstance(value, Scalar) and sign_of(read[name], symbols.signs) in _EXCLUDED.get(sign, ()):
            message = f"{read[name]} is not {sign}, as {name} is declared"
            raise InputError(message, where=where, repair="give a value of that sign, or declare another")
    return read


def inserted(values: Mapping[str, Scalar]) -> dict[str, Scalar]:
    """Return values with those inserted that depend on no other: k = 1/c and c = 2 give k = 1/2.

    Values that depend on each other, as those that exchange two parameters, stay.
    """
    found = dict(values)
    for _ in values:
        settled = {name: value for name, value in found.items() if not symbols_in(value) & found.keys()}
        found = {name: value if name in settled else value.substitute(settled) for name, value in found.items()}
    return found


def _from_numpy(value: Any, where: str) -> object:
    """Return the entries of an array; those of integers, complex numbers and objects are read one by one."""
    if getattr(getattr(value, "dtype", None), "kind", "") == "f":
        message = f"a NumPy array of {value.dtype} holds floating-point numbers"
        raise InexactInput(message, where=where, repair=f'write exact values such as "1/10"{FLOATS}')
    return value.tolist()


def read_complex(value: object, where: str) -> Complex:
    """Return the exact complex number of a SymPy expression, square roots in it as generators."""
    from symobs.exact.sympy_bridge.conversion import complex_from_sympy  # noqa: PLC0415

    return complex_from_sympy(value, where, roots=True)


# -- functions of parameters -------------------------------------------------------------------------------------------
#
# cos θ and sin θ, e⁻ᵀ and roots are generators, letters of their own; what is known of them are the polynomials that
# vanish, cos² θ + sin² θ = 1, and their signs.  What no polynomial says, that e⁻ᵀ decreases with T, is not known here:
# answers then hold for all values of the letters, those that occur among them.


def over_a_base(
    matrices: Mapping[str, Matrix | None], signs: Mapping[str, str], where: str = "plant", *, in_time: bool = False
) -> tuple[dict[str, Matrix | None], tuple[Scalar, ...]]:
    """Return matrices with their functions in a common base, and the polynomials in the base that vanish.

    Functions of time are admitted `in_time`.  Raises `InputError` for others of them, a root of what may be negative, roots
    that may depend on each other, and an entry that divides by 0.
    """
    given = [matrix for matrix in matrices.values() if matrix is not None]
    if all(f.square for f in require_known(given, signs, where, in_time=in_time)):
        return dict(matrices), ()
    try:
        meanings, relations = identities(given)
        moved = {name: None if matrix is None else _in_base(matrix, meanings) for name, matrix in matrices.items()}
        ideal, divides = Ideal.of(relations), [matrix for matrix in moved.values() if matrix is not None]
        divided = any(matrix.common_denominator() in ideal for matrix in divides)
    except NotWritten as error:
        raise InputError(str(error), where=where, repair="declare a symbol for it") from None
    except ZeroDivisionError:
        divided, moved, relations = True, {}, ()
    if divided:
        raise InputError("an entry divides by 0", where=where, repair="divide by what is not 0")
    return moved, relations


def _shifted(radicand: Scalar, signs: Mapping[str, str]) -> str:
    """Return which letter to shift so that a radicand with one factor of open sign is seen to be positive; else nothing."""
    unit, factors = radicand.factors()
    open_factors = [(factor, power) for factor, power in factors if sign_of(factor, signs) != "positive"]
    if len(open_factors) != 1 or open_factors[0][1] % 2 == 0:
        return ""
    factor = open_factors[0][0] if unit.fraction() > 0 else -open_factors[0][0]
    for name in sorted(symbols_in(factor)):
        lead, *rest = factor.coefficients(name) if factor.degree(name) == 1 else (Scalar.of(0),)
        if rest and lead.is_constant and abs(lead.fraction()) == 1 and not rest[0].is_zero:
            return f"{name} = {-rest[0] / lead} {'+' if lead.fraction() > 0 else '-'} d with d positive"
    return ""


def require_known(
    values: Sequence[Matrix | Scalar], signs: Mapping[str, str], where: str, *, in_time: bool = False
) -> frozenset[Function]:
    """Return the functions in values; raises `InputError` where one is not of parameters or equals another one.

    With `in_time`, exponentials, cosines and sines of multiples of t are admitted, too: with t they are analytic.

    Roots are of what the declared signs make positive, since only these are known to be real, and no product of radicands
    is a square; of several roots of numbers, the degrees have no common factor.  So no equation ties them to each other.
    """
    functions = functions_in(values)
    for f in sorted(functions | all_roots(*values), key=lambda f: f.text):
        if f.symbols & {"t", "s", "z"} and not (in_time and _is_of_time(f)):
            message = f"{f.text} is a function of {', '.join(f.symbols & {'t', 's', 'z'})}"
            repair = "entries are rational in t, cos(omega*t), sin(omega*t) and exp(a*t), and have no s or z"
            if f.kind == "exp" and f.symbols & {"s"}:
                message = f"{message}: dead time is not rational"
                repair = "write a Padé approximation, (2 - s)/(2 + s) for exp(-s)"
            raise InputError(message, where=where, repair=repair)
        if f.kind == "sqrt" and not f.square:
            if f.argument.is_constant or any(map(function_named, f.argument.names)):
                repair = "sqrt of numbers and of rational expressions is possible; for other roots declare a symbol"
                raise InputError(f"{f.text} has no exact value here", where=where, repair=repair)
            if sign_of(f.argument, signs) != "positive":
                repair = "declare signs for which its radicand is positive, or a symbol for the root"
                if shifted := _shifted(f.argument, signs):
                    repair = f"put {shifted}, or declare a symbol for the root"
                raise InputError(f"{f.text} has no exact value here: it may not be real", where=where, repair=repair)
    roots = [f for f in functions | all_roots(*values) if f.kind == "sqrt"]
    if are_dependent([f.argument for f in roots]):
        listed = ", ".join(sorted(f.text for f in roots))
        raise InputError(
            f"roots that depend on each other: {listed}", where=where, repair="write one of them with the others"
        )
    degrees = [f.number.degree for f in functions if isinstance(f, RealRoot)]
    degrees += [2] if any(f.square for f in functions | all_roots(*values)) else []
    if lcm(*degrees) != prod(degrees):
        listed = ", ".join(sorted(f.text for f in functions if isinstance(f, RealRoot)))
        message = f"roots that may depend on each other: {listed}"
        raise InputError(message, where=where, repair="write all of them with one root, r^2 for another")
    return functions


def _is_of_time(f: Function) -> bool:
    """Return whether this is an exponential, a cosine or a sine of a + b t."""
    rate = derivative(f.argument)
    return f.kind in KINDS and not rate.is_zero and not (symbols_in(rate) & {"t"}) and not f.symbols & {"s", "z"}


def _in_base(matrix: Matrix, meanings: Mapping[str, Scalar]) -> Matrix:
    images = {name: meanings[name] for name in matrix.names if name in meanings}
    return matrix.substitute(images) if images else matrix


@lru_cache(maxsize=256)
def is_identity(value: Scalar) -> bool:
    """Return whether a polynomial vanishes because of what its functions are, as cos² θ + sin² θ − 1 does."""
    if not any(function_named(name) for name in value.names):
        return False
    return any(value in {relation, -relation} for relation in identities([value])[1])


# The four exact matrices of a plant, and the check of their shapes; the functions of a nonlinear one.


class Matrices:
    """The four exact matrices of a plant; a missing one has no columns (B) or no rows (C)."""

    def __init__(self, A: Matrix, B: Matrix | None, C: Matrix | None, D: Matrix | None) -> None:
        """Complete missing matrices; D is zero.

        All have the same roots of numbers in their fields, and no symbol that occurs in none of them: a plant of numbers
        is one of numbers, whatever the transfer function was written in that it realises.
        """
        order = A.shape[0]
        self.A = A
        self.B = Matrix.zeros(order, 0) if B is None else B
        self.C = Matrix.zeros(0, order) if C is None else C
        self.D = Matrix.zeros(self.C.shape[0], self.B.shape[1]) if D is None else D
        self.has_input, self.has_output = B is not None, C is not None
        numbers = self.A.field.numbers | self.B.field.numbers | self.C.field.numbers | self.D.field.numbers
        if numbers.names:  # what factors over these numbers does so for every matrix
            self.A, self.B, self.C, self.D = (m.within(m.field | numbers) for m in (self.A, self.B, self.C, self.D))
        parts = self.A, self.B, self.C, self.D
        idle = (
            frozenset[str]().union(*(m.field.names for m in parts)).difference(numbers.names, *(m.names for m in parts))
        )
        if idle:
            self.A, self.B, self.C, self.D = (m.within(m.field.without(idle)) for m in parts)

    @property
    def has_feedthrough(self) -> bool:
        """Whether D is not zero."""
        return not self.D.is_zero

    @property
    def symbols(self) -> frozenset[str]:
        """The plain symbols of the entries, those inside functions too."""
        return symbols_in(self.A) | symbols_in(self.B) | symbols_in(self.C) | symbols_in(self.D)

    def __eq__(self, other: object) -> bool:
        return self._value == other._value if isinstance(other, Matrices) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.A, self.B, self.C))

    @property
    def _value(self) -> tuple[object, ...]:
        return self.A, self.B, self.C, self.D, self.has_input, self.has_output


#: A vector in parentheses: (1, 0), (1, 0)^T.
VECTOR = re.compile(r"\s*\(([^()]*,[^()]*)\)\s*(?:'|\^T|ᵀ)?\s*")


def as_rows(name: str, value: Any) -> Any:
    """Return the rows of a matrix: a flat list is a column of B or a row of C or D, a number a 1×1 matrix.

    A vector in parentheses, (1, 0) or (1, 0)^T, is such a list; LaTeX is read as a text of a problem file.
    """
    if isinstance(value, str):
        value = without_latex(value)
        vector = VECTOR.fullmatch(value) if name != "A" else None
        return f"[{vector[1].replace(',', ';') if name == 'B' else vector[1]}]" if vector else value
    if (
        value is None
        or isinstance(value, (str, Matrix, dict, set))
        or (hasattr(value, "shape") and len(value.shape) == 2)
    ):
        return value
    listed = value.tolist() if hasattr(value, "tolist") else value
    if not isinstance(listed, (list, tuple)):
        return [[value]]
    if name == "A" or any(isinstance(row, (list, tuple)) or getattr(row, "shape", ()) for row in listed):
        return value
    return [[entry] for entry in listed] if name == "B" else [list(listed)]


def shape_errors(parts: Mapping[str, Matrix | None]) -> list[SymobsError]:
    """Return the faults in the shapes of A, B, C and D; None stands for a matrix that is not given."""
    A, B, C, D = parts["A"], parts["B"], parts["C"], parts["D"]
    errors: list[SymobsError] = []

    def expect(name: str, wanted: str, came: Matrix) -> None:
        message = f"{name} is {came.shape[0]}×{came.shape[1]}, expected {wanted}"
        errors.append(
            ShapeMismatch(message, where=f"plant.{name}", repair=f"write {name} as {wanted.split(',', maxsplit=1)[0]}")
        )

    if A is None:
        return [InputError("A is missing", where="plant.A", repair='give the state matrix, for example "[0 1; 0 -1]"')]
    order = A.shape[0]
    if order == 0 or A.shape[1] != order:
        expect("A", "a square matrix", A)
        return errors
    if B is not None and (B.shape[0] != order or B.shape[1] == 0):
        expect("B", f"a matrix of {order} rows, one for each state", B)
    if C is not None and (C.shape[1] != order or C.shape[0] == 0):
        expect("C", f"a matrix of {order} columns, one for each state", C)
    if D is not None and not errors:
        rows, columns = (C.shape[0] if C is not None else 0), (B.shape[1] if B is not None else 0)
        if D.shape != (rows, columns):
            expect("D", f"a {rows}×{columns} matrix, outputs by inputs", D)
    return errors


@dataclass
class Nonlinear:
    """A plant ẋ = f(x, u), y = h(x, u) (x(k+1) = f in discrete time) and an equilibrium of it, by name.

    It comes from its equations of motion where there are any.  Where there is the equilibrium some values are `positive` and
    others `nonzero`; what it leaves free is its own value, or has one of the `new_names` where the linearisation depends on it.
    """

    f: Matrix
    h: Matrix | None
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    equilibrium: tuple[tuple[str, Scalar], ...]
    motion: Motion | None = None
    positive: tuple[Scalar, ...] = ()
    nonzero: tuple[Scalar, ...] = ()
    new_names: frozenset[str] = frozenset()
    #: The values of inputs that are given: of the equilibria those are meant that have them.
    held: tuple[tuple[str, Scalar], ...] = ()

    @property
    def free(self) -> tuple[str, ...]:
        """The states and inputs that the equilibrium leaves free."""
        return tuple(name for name, value in self.equilibrium if value == Scalar.symbol(name))

    def at_rest(self, known: Mapping[str, Scalar], *, is_discrete: bool) -> list[Scalar]:
        """Return what is 0 at an equilibrium with some known values: the equations without their derivatives, or f."""
        if self.motion is not None:
            still = {**dict.fromkeys(self.motion.derivatives, Scalar.of(0)), **known}
            return [substitute(equation, still) for equation in self.motion.equations]
        rest = [f - Scalar.symbol(x) if is_discrete else f for f, x in zip(self.f.entries, self.states, strict=True)]
        return [substitute(entry, known) for entry in rest]

    def jacobian(self, function: Matrix, names: Sequence[str]) -> Matrix:
        """Return ∂ function / ∂ names, a column for each name."""
        return Matrix.block([[derivative(function, name) for name in names]])

    def there(self, value: Matrix) -> Matrix:
        """Return a matrix at the equilibrium; raises ZeroDivisionError where it is not defined there."""
        return substitute(value, dict(self.equilibrium))

    def moved(self, values: Mapping[str, Scalar]) -> Nonlinear:
        """Return the plant with parameters replaced."""
        point = tuple((name, substitute(value, values)) for name, value in self.equilibrium)
        f, h = substitute(self.f, values), None if self.h is None else substitute(self.h, values)
        motion = None if self.motion is None else self.motion.moved(values)
        positive = tuple(substitute(value, values) for value in self.positive)
        held = tuple((name, substitute(value, values)) for name, value in self.held)
        nonzero = tuple(substitute(value, values) for value in self.nonzero)
        return Nonlinear(
            f, h, self.states, self.inputs, point, motion, positive, nonzero, self.new_names - {*values}, held
        )


# The time domain as a type: `Continuous`, `TimeVarying` or `Discrete`.


@dataclass
class Continuous:
    """Continuous time: ẋ, the variable s, stability in the open left half-plane."""

    variable = "s"


@dataclass
class TimeVarying(Continuous):
    """Continuous time t, which the matrices themselves may contain: ẋ = A(t) x + B(t) u."""

    variable = "t"


@dataclass
class Discrete:
    """Discrete time: x(k+1), the variable z, stability in the open unit disc; `period` if it is known."""

    period: Scalar | None = None
    variable = "z"


TimeDomain = Continuous | Discrete


def read_time(dt: object, symbols: Symbols) -> TimeDomain:
    """Return the time domain of `dt`: 0 is continuous, True or a positive value discrete."""
    if dt is True:
        return Discrete()
    if dt is False or dt is None:
        return Continuous()
    value = read_scalar(str(dt) if isinstance(dt, float) else dt, symbols, "plant.dt")
    if value.is_zero:
        return Continuous()
    if sign_of(value, symbols.signs) != "positive":
        message = f"{value} is not a sampling period"
        repair = "write 0 for continuous time, true, a positive number, or a symbol that is declared positive"
        raise InputError(message, where="plant.dt", repair=repair)
    return Discrete(value)
