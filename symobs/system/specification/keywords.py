"""Specifications of a design: a desired polynomial, given by poles or coefficients, or a gain.

`KINDS` names every type a task's keyword may have.  A task's signature is its schema: the annotation of a keyword is
the name of a kind, and the problem file, the command line and Python all read through it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

from symobs.exact import Complex, Field, Matrix, Scalar, modulo, product_of
from symobs.exact.algebraic.rounded_decimals import conjugates, is_in_kernel, product_of_linear, tidied
from symobs.exact.core.generators import (
    NotWritten,
    all_roots,
    functions_in,
    identities,
    roots_in,
    square_root,
    symbols_in,
)
from symobs.formula.expression import (
    comma_between_digits,
    declared_name,
    parse_matrix,
    parse_poles,
    parse_polynomial,
    without_comma,
)
from symobs.formula.expression.tokenizer import CONSTRUCTORS
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.system import Matrices, StateSpace, Symbols, is_sympy, read_complex, read_matrix, read_scalar
from symobs.system.conditions import sign_of
from symobs.system.reading import VECTOR, as_rows, require_known
from symobs.system.specification.pole_patterns import (
    FILTERS,
    KEYS,
    OTHERS,
    PolePattern,
    is_pattern,
    named_parts,
    pattern_of,
    refuse_names_of_patterns,
)

if TYPE_CHECKING:
    from collections.abc import Mapping


#: The kinds of keyword a task may have.  Their names in signatures are the schema, as text or as annotations.
Poles: TypeAlias = Annotated[Any, "Poles"]
PolynomialText: TypeAlias = Annotated[Any, "PolynomialText"]
TransferFunctionText: TypeAlias = Annotated[Any, "TransferFunctionText"]
GainText: TypeAlias = Annotated[Any, "GainText"]
MatrixText: TypeAlias = Annotated[Any, "MatrixText"]
IntervalText: TypeAlias = Annotated[Any, "IntervalText"]
SignalText: TypeAlias = Annotated[Any, "SignalText"]
Name: TypeAlias = Annotated[str, "Name"]
Horizon: TypeAlias = Annotated[Any, "Horizon"]
TimeFunctions: TypeAlias = Annotated[Any, "TimeFunctions"]
Intensity: TypeAlias = Annotated[Any, "Intensity"]
Sign: TypeAlias = Annotated[Any, "Sign"]
Entries: TypeAlias = Annotated[Any, "Entries"]
Quantity: TypeAlias = Annotated[Any, "Quantity"]
Names: TypeAlias = Annotated[Any, "Names"]


KINDS: dict[str, dict[str, Any]] = {
    "Poles": {
        "description": 'poles: a list or a comma-separated text, "-20+20i, -20-20i", "-p"; or what they are to do, '
        '"damping = 1/2, natural_frequency = 3", "butterworth = omega_0"',
        "oneOf": [
            {"type": "string"},
            {"type": "array", "items": {"type": ["number", "string"]}},
            {"type": "object", "propertyNames": {"enum": list(KEYS)}},
        ],
    },
    "PolynomialText": {"description": 'a monic polynomial, "(s + 10)^2"', "type": "string"},
    "TransferFunctionText": {"description": 'a rational function, "10 (s + 1)/(s + 10)"', "type": ["string", "number"]},
    "GainText": {
        "description": 'a gain, "[19; 81]"',
        "oneOf": [{"type": "string"}, {"type": "array"}],
    },
    "MatrixText": {
        "description": 'a matrix, "[1 0; 0 1]"',
        "oneOf": [{"type": "string"}, {"type": "array"}],
    },
    "IntervalText": {
        "description": 'an interval of time, "0, T"',
        "oneOf": [{"type": "string"}, {"type": "array", "items": {"type": ["number", "string"]}}],
    },
    "SignalText": {
        "description": 'a signal as a function of the time t, "t^2" or "[t; 1]"',
        "oneOf": [{"type": "string"}, {"type": "number"}, {"type": "array"}],
    },
    "Entries": {
        "description": 'entries of a matrix: (row, column) counted from 1, "(1, 2), (3, 1)", or a pattern, "[* 0; * *]"',
        "oneOf": [{"type": "string"}, {"type": "array"}],
    },
    "Quantity": {"description": 'a positive quantity: "omega_0", 10, "1/2"', "type": ["string", "number"]},
    "Names": {
        "description": 'names of parameters: a list or a comma-separated text, "h1, h2"',
        "oneOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
    },
    "Sign": {"description": "1 or -1", "enum": [1, -1]},
    "Name": {"description": "a name", "type": "string"},
    "Horizon": {"description": 'the end of the interval [0, T]: "T", 2, or "inf"', "type": ["string", "number"]},
    "TimeFunctions": {
        "description": 'functions of t, one for each component: "exp(-t) + 2 t sin(3 t)"',
        "oneOf": [{"type": "string"}, {"type": "array"}, {"type": "number"}],
    },
    "Intensity": {
        "description": 'a symmetric matrix, a weight or the intensity of white noise: "q" (for q I) or "[q1 0; 0 q2]"',
        "oneOf": [{"type": "string"}, {"type": "array"}, {"type": "number"}],
    },
}


#: The words a keyword of the kind Name may be; those of `method` are the task's methods.
CHOICES: dict[str, tuple[str, ...]] = {
    "choose": ("simple", "small"),
    "kind": ("controllable", "observable", "modal"),
    "meaning": ("asymptotic", "lyapunov"),
    "member": ("simple", "decoupled"),
    "observer": ("full", "minimal"),
    "of": ("observability", "controllability"),
    "rule": ("forward", "backward", "tustin"),
}


@dataclass
class DesiredPolynomial:
    """A monic polynomial φ of degree n with real coefficients: its factors, and its poles, or their pattern, if given."""

    variable: str
    factors: tuple[Scalar, ...]
    poles: tuple[Complex, ...] = ()
    #: What the poles are to do, where they are given so.
    pattern: PolePattern | None = None
    #: Which gain is to be taken where several assign φ: the `simple` one, a `small` one, or by `auto` what is usable.
    choose: str = "auto"

    @cached_property
    def polynomial(self) -> Scalar:
        """φ, multiplied out."""
        return product_of(self.factors)

    @cached_property
    def coefficients(self) -> tuple[Scalar, ...]:
        """The coefficients after the leading one: α₁ … αₙ of sⁿ + α₁ sⁿ⁻¹ + … + αₙ."""
        return self.polynomial.coefficients(self.variable)[1:]

    @property
    def degree(self) -> int:
        """The degree of φ."""
        return sum(factor.degree(self.variable) for factor in self.factors)

    @property
    def is_numeric(self) -> bool:
        """Whether φ has no parameter."""
        return all(factor.names <= {self.variable} for factor in self.factors)

    @property
    def is_expanded(self) -> bool:
        """Whether the product of the factors is φ multiplied out: one factor, or a power of the variable."""
        return len(self.factors) == 1 or all(c.is_zero for c in self.coefficients)

    def grouped(self) -> tuple[tuple[Scalar, int], ...]:
        """Return the distinct factors with multiplicities, in the order they were given."""
        counted: dict[Scalar, int] = {}
        for factor in self.factors:
            counted[factor] = counted.get(factor, 0) + 1
        return tuple(counted.items())

    def substitute(self, values: dict[str, Scalar]) -> DesiredPolynomial:
        """Return φ with parameters substituted."""
        poles = tuple(Complex(p.real.substitute(values), p.imaginary.substitute(values)) for p in self.poles)
        factors = tuple(f.substitute(values) for f in self.factors)
        return DesiredPolynomial(self.variable, factors, poles, choose=self.choose)


def desired_polynomial(
    plant: StateSpace,
    poles: object,
    polynomial: object,
    *,
    names: tuple[str, str] = ("poles", "polynomial"),
    degree: int | None = None,
    required: bool = True,
    choose: str = "auto",
) -> DesiredPolynomial | None:
    """Return φ read from `poles` or from `polynomial`, exactly one of which must be given.

    Raises `InputError` where the degree is not the order asked for, where poles of a real design are not closed under
    conjugation (naming the missing one), where the polynomial is not monic, or for a choice of gain that has no such name.
    """
    if choose not in ("auto", *CHOICES["choose"]):
        message = f"{choose[:40]!r} is no choice of a gain"
        raise InputError(message, where="specification.choose", repair='write "simple" or "small"')
    degree = plant.order if degree is None else degree
    first, second = (f"specification.{name}" for name in names)
    if poles is None and polynomial is None:
        if not required:
            return None
        message = f"{names[0]} are missing"
        article = "an" if names[1].startswith("o") else "a"
        repair = f'give {names[0]} = "{", ".join(str(-k) for k in range(1, degree + 1))}" or {article} {names[1]}'
        raise InputError(message, where=first, repair=repair)
    if poles is not None and polynomial is not None:
        raise InputError(f"both {names[0]} and {names[1]} are given", where=first, repair="keep one of them")
    if is_pattern(poles):
        found = _from_pattern(poles, plant, degree, first)
    elif poles is not None:
        read = read_poles(poles, plant.symbols, first, plant.variable, letters=plant.field.names)
        if len(read) != degree:
            raise _miscounted(poles, read, degree, first)
        found = _from_poles(read, plant.variable, first)
    else:
        found = _from_polynomial(polynomial, plant, degree, second)
    require_known(found.factors, plant.symbols.signs, second if poles is None else first)
    return found if choose == "auto" else replace(found, choose=choose)


def read_poles(
    value: Any,
    symbols: Symbols,
    where: str,
    variable: str | None = None,
    *,
    functions: bool = True,
    letters: Iterable[str] = (),
) -> tuple[Complex, ...]:
    """Return exact poles from a text or a list of numbers, texts and SymPy expressions.

    `variable` is that of φ, `letters` are names in use.
    """
    if functions:
        refuse_names_of_patterns(value, symbols.signs, where)
    if isinstance(value, str):
        return parse_poles(
            value, symbols.names, variable=variable, where=where, roots=True, functions=functions, letters=letters
        )
    if is_sympy(value) and (hasattr(value, "tolist") or type(value).__name__ == "Tuple"):
        value = list(value)  # a Matrix, or a Tuple
    listed = value.tolist() if hasattr(value, "tolist") else value  # a NumPy array
    entries = listed if isinstance(listed, Sequence) else [listed]
    read = [
        read_complex(entry, f"{where}[{index}]") if is_sympy(entry) else entry for index, entry in enumerate(entries)
    ]
    return parse_poles(
        read, symbols.names, variable=variable, where=where, roots=True, functions=functions, letters=letters
    )


def _miscounted(poles: object, read: Sequence[Complex], degree: int, where: str) -> InputError:
    """Return the error of too many poles or too few; a comma between digits may have been meant as that of a decimal.

    Where the conjugates of those that are given make up the number, they are what is missing.
    """
    count = len(read)
    partners = {pole: Complex(pole.real, -pole.imaginary) for pole in read if not pole.is_real}
    missing = [(pole, partner) for pole, partner in partners.items() if partner not in read]
    if missing and count + len(missing) == degree:
        listed = " and ".join(f"{partner} beside {pole}" for pole, partner in missing)
        message = f"the poles are not closed under conjugation: {listed} {'is' if len(missing) == 1 else 'are'} missing"
        add = ", ".join(str(partner) for _, partner in missing)
        return InputError(message, where=where, repair=f"add {add}", given=count)
    message = f"{count} pole{'s' if count != 1 else ''} given, {degree} needed"
    repair = f"give as many poles as the order asks for, {degree}, with commas between"
    comma = comma_between_digits(poles)
    if comma:
        point, _, thousands = without_comma(comma).partition(" with a decimal point")
        repair += f"; if one of them is {point}, write it with a decimal point{thousands}"
    return InputError(message, where=where, repair=repair, given=count)


def _from_poles(poles: tuple[Complex, ...], variable: str, where: str) -> DesiredPolynomial:
    if any(variable in part.names for pole in poles for part in (pole.real, pole.imaginary)):
        message = f"a pole contains {variable}, the variable of the polynomials"
        raise InputError(message, where=where, repair="write another name")
    if all(is_in_kernel(part) and not part.field.roots for pole in poles for part in (pole.real, pole.imaginary)):
        return DesiredPolynomial(variable, _factors_of_pairs(poles, variable, where), poles)
    factors, waiting = list[Scalar](), list(map(tidied, poles))
    while waiting:
        families = (conjugates(waiting[0], of_numbers=choice) for choice in (True, False))
        complete = (family for family in families if all(pole in waiting for pole in family))
        found = ((family, product_of_linear(variable, family)) for family in complete)
        family, factor = next(((family, factor) for family, factor in found if factor is not None), ((), None))
        if factor is None:
            raise _not_closed(waiting, where)
        for pole in family:
            waiting.remove(pole)
        factors.append(factor)
    return DesiredPolynomial(variable, tuple(factors), poles)


def _from_pattern(value: object, plant: StateSpace, degree: int, where: str) -> DesiredPolynomial:
    if plant.is_discrete:
        message = "damping, settling time and filters are of continuous time"
        raise InputError(message, where=where, repair="give the poles themselves, z = exp(s T)")
    named, others = read_pattern(value, plant, where)
    signs = plant.symbols.seen(value).signs
    pattern = pattern_of(named, degree - len(others), plant.variable, where, signs, len(others))
    beside = _from_poles(others, plant.variable, where).factors
    return DesiredPolynomial(plant.variable, (*pattern.factors, *beside), pattern=pattern)


def read_pattern(value: object, plant: StateSpace, where: str) -> tuple[dict[str, Scalar], tuple[Complex, ...]]:
    """Return what is given by name, exact, and the poles beside it."""
    parts = named_parts(value, where)
    others = parts.pop(OTHERS, ())
    named = {
        name: read_quantity(
            part, plant, "natural frequency ω₀" if name in FILTERS else name, f"{where}.{name}", functions=True
        )
        for name, part in parts.items()
    }
    return named, read_poles(
        others, plant.symbols, f"{where}.{OTHERS}", plant.variable, letters=plant.field.names
    ) if others else ()


def _not_closed(waiting: Sequence[Complex], where: str) -> InputError:
    """Return the error for poles, of which those of the first one are not all there, or make no polynomial of the data."""
    pole = waiting[0]
    partner = next((other for other in conjugates(pole, of_numbers=False) if other not in waiting), None)
    roots = sorted({root.text for part in (pole.real, pole.imaginary) for root in all_roots(part) if root.symbols})
    if partner is not None and pole.is_real and roots:  # both are real: what is missing is no conjugate
        message = f"the polynomial of the poles has {roots[0]} in its coefficients, which is no number of the data"
        repair = f'declare a symbol for it, w = "positive", and write w for {roots[0]} in the poles and its square in the data'
        return InputError(message, where=where, repair=repair)
    if partner is not None:
        message = f"the poles are not closed under conjugation: {partner} is missing beside {pole}"
        return InputError(message, where=where, repair=f"replace one of the poles by {partner}")
    message = f"the polynomial with the pole {pole} has coefficients that are not in the field of the data"
    repair = "give poles whose product is free of roots, but for those of rational numbers"
    return InputError(message, where=where, repair=repair)


def _factors_of_pairs(poles: tuple[Complex, ...], variable: str, where: str) -> tuple[Scalar, ...]:
    """Return one factor for each real pole and each pair, for poles without roots."""
    field = Field.of(
        [variable, *(name for pole in poles for part in (pole.real, pole.imaginary) for name in part.field.names)]
    )
    s = Scalar.symbol(variable).within(field)
    waiting = [Complex(pole.real.within(field), pole.imaginary.within(field)) for pole in poles]
    factors: list[Scalar] = []
    while waiting:
        pole = waiting.pop(0)
        if pole.is_real:
            factors.append(s - pole.real)
            continue
        partner = pole.conjugate()
        if partner not in waiting:
            raise _not_closed([pole, *waiting], where)
        waiting.remove(partner)
        factors.append((s - pole.real) ** 2 + pole.imaginary**2)
    return tuple(factors)


def _from_polynomial(value: object, plant: StateSpace, degree: int, where: str) -> DesiredPolynomial:
    variable = plant.variable
    if is_pattern(value):
        key = where.rpartition(".")[2].replace("polynomial", "poles")
        message = f"an expression in {variable} is expected, but what poles are to do came"
        raise InputError(message, where=where, repair=f"give it as {key}")
    if is_sympy(value):
        polynomial = read_scalar(value, plant.symbols, where, functions=True)
    else:
        polynomial = parse_polynomial(value, variable, plant.symbols.names, where=where, functions=True)
    found = polynomial.degree(variable)
    if not polynomial.is_polynomial_in(variable) or found < 1:
        message = f"{polynomial} is not a polynomial in {variable}"
        raise InputError(message, where=where, repair=f'write for example "{variable}^2 + 4 {variable} + 4"')
    if found != degree:
        message = f"a polynomial of degree {found} given, degree {degree} needed"
        raise InputError(message, where=where, repair=f"give a polynomial of degree {degree}", given=found)
    lead = polynomial.coefficients(variable)[0]
    if not lead.is_one:
        message = f"the polynomial is not monic, its leading coefficient is {lead}"
        raise InputError(message, where=where, repair=f"divide it by {lead}")
    return DesiredPolynomial(variable, _monic_factors(polynomial, variable))


def _monic_factors(polynomial: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return the irreducible factors that contain the variable, made monic, those of lower degree first."""
    factors: list[Scalar] = []
    for factor, power in polynomial.numerator.factors()[1]:
        if factor.degree(variable) > 0:
            factors += [factor / factor.coefficients(variable)[0]] * power
    return tuple(sorted(factors, key=lambda f: f.degree(variable)))


#: A matrix by a word.
_MADE = re.compile(rf"(?<!\w)(?:{'|'.join(CONSTRUCTORS)})\s*\(")


def from_list(value: Any, *, column: bool) -> Any:
    """Return a flat list, or the text of one, as a column or a row, anything else as it is."""
    if isinstance(value, str) and "[" not in value and "," in value and not _MADE.search(value):
        entries = VECTOR.fullmatch(value)
        inside = entries[1] if entries else value
        return f"[{inside.replace(',', ';') if column else inside}]"
    return as_rows("B" if column else "C", value)


#: What a row could take for another one: K is a row where L is a column.
_GAINS = {"K", "L", "M", "H"}


def read_gain(value: object, plant: StateSpace, name: str, shape: tuple[int, int]) -> Matrix:
    """Return a given gain, a flat list where it is a row or a column; raises ShapeMismatch for another shape."""
    where = f"specification.{name}"
    gain = read_matrix(from_list(value, column=shape[1] == 1), plant.symbols.seen(value), where, functions=True)
    if shape[1] == 1 and gain.shape == (1, shape[0]) and name not in _GAINS:  # a column that is written as a row, or 0
        gain = gain.T
    elif shape[1] == 1 and gain == Matrix.zeros(1, 1):
        gain = Matrix.zeros(*shape)
    if gain.shape != shape:
        message = f"{name} is {gain.shape[0]}×{gain.shape[1]}, expected {shape[0]}×{shape[1]}"
        raise ShapeMismatch(message, where=where, repair=f"write {name} as a {shape[0]}×{shape[1]} matrix")
    return constant(gain, plant, name, where)


def constant(value: Matrix, plant: StateSpace, name: str, where: str) -> Matrix:
    """Return a matrix; raises `InputError` where the time or the variable of polynomials stands in it."""
    if symbols_in(value) & {plant.variable, "t"}:
        message = f"{name} contains a name that stands for the time or the variable of polynomials"
        raise InputError(message, where=where, repair="give the parameter another name")
    return value


def read_symmetric(value: object, plant: StateSpace, name: str, size: int) -> Matrix:
    """Return a symmetric matrix; a single value q stands for q I.  Raises `InputError`, `ShapeMismatch`."""
    where = f"specification.{name}"
    listed = value if isinstance(value, (str, list, tuple)) or hasattr(value, "shape") else [[value]]
    found = read_matrix(listed, plant.symbols.seen(value), where)
    if found.shape == (1, 1):
        found = Matrix.identity(size) * found[0, 0]
    if found.shape != (size, size):
        message = f"{name} is {found.shape[0]}×{found.shape[1]}, expected {size}×{size}"
        raise ShapeMismatch(message, where=where, repair=f"write {name} as a symmetric {size}×{size} matrix")
    if found != found.T:
        i, j = next((i, j) for i in range(size) for j in range(i) if found[i, j] != found[j, i])
        message = f"{name} is not symmetric: its entries ({j + 1}, {i + 1}) and ({i + 1}, {j + 1}) differ"
        raise InputError(message, where=where, repair=f"write {name} as a symmetric {size}×{size} matrix")
    return constant(found, plant, name, where)


def read_quantity(value: object, plant: StateSpace, name: str, where: str = "", *, functions: bool = False) -> Scalar:
    """Return a real quantity free of the variable; raises `InputError` if it is certainly not positive."""
    where = where or f"specification.{name}"
    quantity = read_scalar(value, plant.symbols.seen(value), where, functions=functions)
    if plant.variable in quantity.names:
        message = f"{name} contains {plant.variable}, the variable of the polynomials"
        raise InputError(message, where=where, repair="write another name")
    if sign_of(quantity, plant.symbols.signs) in {"zero", "negative", "nonpositive"}:
        raise InputError(f"{name} is {quantity}, which is not positive", where=where, repair=f"give a positive {name}")
    return quantity


def read_names(value: object, name: str) -> tuple[str, ...]:
    """Return the names of a list or a text, possibly none; raises `InputError` for a repeated name."""
    where = f"specification.{name}"
    listed = re.split(r"[,;\s]+", value.strip(" []")) if isinstance(value, str) else value
    listed = [str(entry) for entry in (listed if isinstance(listed, (list, tuple)) else [listed])]
    found = [declared_name(entry, where) for entry in listed if entry]
    if len(set(found)) < len(found):
        repair = f'write for example {name} = "{", ".join(dict.fromkeys(found))}"'
        raise InputError("a parameter is named twice", where=where, repair=repair)
    return tuple(found)


def read_interval(value: object, plant: StateSpace) -> tuple[Scalar, Scalar]:
    """Return the two ends of a time interval; raises `InputError` unless they are real, free of t and in order."""
    where = "specification.interval"
    ends = read_poles(value, plant.symbols, where)
    if len(ends) != 2 or not all(end.is_real for end in ends):
        message = f"an interval has two real ends, but {len(ends)} came"
        raise InputError(message, where=where, repair='write for example interval = "0, T"')
    start, end = (end.real for end in ends)
    if plant.variable in start.names | end.names:
        message = f"the ends of the interval contain the time {plant.variable}"
        raise InputError(message, where=where, repair='write another name: interval = "0, T"')
    if sign_of(end - start, plant.symbols.signs) in {"zero", "negative", "nonpositive"}:
        message = f"the interval from {start} to {end} has no length"
        raise InputError(message, where=where, repair="give the earlier end first")
    return start, end


def reject_both(name: str, gain: object, poles: object, polynomial: object, other: str = "poles") -> None:
    """Raise `InputError` if a gain is given together with desired poles."""
    if gain is not None and (poles is not None or polynomial is not None):
        message = f"both {name} and {other if poles is not None else 'polynomial'} are given"
        raise InputError(message, where=f"specification.{name}", repair="keep one of them")


# Entries of a gain that are to vanish: pairs (row, column), or a pattern of 0 and *.


def read_entries(value: object, name: str, shape: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    """Return entries, counted from 0, from pairs (row, column) counted from 1 or from a pattern of 0 and *."""
    where = f"specification.{name}"
    rows = value if isinstance(value, (list, tuple)) else [value]
    text = "; ".join(" ".join(map(str, row)) if isinstance(row, (list, tuple)) else str(row) for row in rows)
    if "*" in text or set(re.findall(r"[0-9]+", text)) == {"0"}:
        return _read_pattern(text, where, shape)
    numbers = [int(digits) for digits in re.findall(r"[0-9]{1,4}", text)]
    if not numbers or len(numbers) % 2 or re.search(r"[^0-9,;\s()\[\]]", text):
        message = f"{text[:40]!r} is no list of entries"
        raise InputError(message, where=where, repair='write (row, column) counted from 1: "(1, 2), (3, 1)"')
    found = tuple(dict.fromkeys((i - 1, j - 1) for i, j in zip(numbers[::2], numbers[1::2], strict=True)))
    for i, j in found:
        if not (0 <= i < shape[0] and 0 <= j < shape[1]):
            message = f"there is no entry ({i + 1}, {j + 1}) in a {shape[0]}×{shape[1]} gain"
            raise InputError(
                message, where=where, repair='count rows and columns from 1, or write a pattern, "[* 0; * *]"'
            )
    return found


def _read_pattern(text: str, where: str, shape: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    """Return the places of the zeros of a pattern."""
    rows = [row.replace(",", " ").split() for row in text.strip(" []").replace("\n", ";").split(";")]
    if any(sign not in {"0", "*"} for row in rows for sign in row):
        message = f"the pattern {text[:40]!r} has other signs than 0 and *"
        raise InputError(message, where=where, repair='write for example "[* 0; * *]"')
    if (len(rows), *{len(row) for row in rows}) != shape:
        message = f"the pattern {text[:40]!r} is not {shape[0]}×{shape[1]}"
        raise ShapeMismatch(message, where=where, repair=f"write {shape[0]} rows of {shape[1]} signs 0 or *")
    return tuple((i, j) for i, row in enumerate(rows) for j, sign in enumerate(row) if sign == "0")


# Functions of parameters in poles and polynomials: plant and polynomials over one base, with what vanishes there.


def in_common_field(plant: StateSpace, *asked: Any) -> tuple[StateSpace, tuple[Any, ...]]:
    """Return a plant and what is asked for, the functions in desired polynomials and further matrices among its data.

    cos θ and e⁻ᵀ are letters of their own, as in the entries of a plant; on the plant that is returned cos² θ + sin² θ = 1
    holds.  Raises `InputError` for a function of s or z, and for a root that is not known to be real.
    """
    wanted = [one for one in asked if isinstance(one, DesiredPolynomial)]
    factors = [factor for one in wanted for factor in one.factors]
    further = [one for one in asked if isinstance(one, Matrix)]
    if all(function.square for function in functions_in([*factors, *further])):
        return plant, asked
    m = plant.matrices
    parts = [part for one in wanted for pole in one.poles for part in (pole.real, pole.imaginary)]
    try:
        meanings, _ = identities([m.A, m.B, m.C, m.D, *plant.equations, *factors, *parts, *further])
    except NotWritten as error:
        raise InputError(str(error), where="specification", repair="declare a symbol for it") from None
    there = copy(plant)
    there.__dict__.pop("field", None)
    A, B, C, D = (_moved_matrix(matrix, meanings) for matrix in (m.A, m.B, m.C, m.D))
    there.matrices = Matrices(A, B if m.has_input else None, C if m.has_output else None, D)
    there.equations = tuple(_moved(equation, meanings).numerator for equation in plant.equations)
    if plant.written is not None and there.matrices != m:
        message = "the transfer function and the poles have functions of different multiples of one argument"
        raise InputError(
            message, where="specification", repair="write both with the smaller one, exp(-T)^2 for exp(-2 T)"
        )
    moved = [_moved(factor, meanings) for factor in factors]
    further = [_moved_matrix(matrix, meanings) for matrix in further]
    there = there.restricted(identities([A, B, C, D, *moved, *further])[1])

    def over(one: Any) -> Any:
        if isinstance(one, Matrix):
            return modulo(_moved_matrix(one, meanings), there.ideal)
        return _over(one, meanings, there) if isinstance(one, DesiredPolynomial) else one

    return there, tuple(map(over, asked))


def _over(desired: DesiredPolynomial, meanings: Mapping[str, Scalar], there: StateSpace) -> DesiredPolynomial:
    """Return a desired polynomial over the data of a plant, its factors simplified by what vanishes there."""
    factors = []
    for factor in desired.factors:
        moved = _moved(factor, meanings)
        if not there.admits(moved):
            raise _divides_by_zero()
        short = there.simplified(moved)
        factors.append(short if short.coefficients(desired.variable)[0].is_one else moved)
    poles = tuple(Complex(_moved(pole.real, meanings), _moved(pole.imaginary, meanings)) for pole in desired.poles)
    own = desired.pattern
    pattern = None
    if own is not None:
        values = tuple((name, _moved(value, meanings)) for name, value in own.values)
        pattern = replace(own, values=values, factors=tuple(factors[: len(own.factors)]))
    return replace(desired, factors=tuple(factors), poles=poles, pattern=pattern)


def _moved(value: Scalar, meanings: Mapping[str, Scalar]) -> Scalar:
    """Return a value in the base, the radicands of its roots too."""
    images = {name: meanings[name] for name in value.names if name in meanings}
    for root in roots_in(value):
        if not root.argument.is_constant:
            images[root.name] = square_root(_moved(root.argument, meanings))
    try:
        return value.substitute(images) if images else value
    except ZeroDivisionError:
        raise _divides_by_zero() from None


def _divides_by_zero() -> InputError:
    return InputError("a coefficient divides by 0", where="specification", repair="divide by what is not 0")


def _moved_matrix(matrix: Matrix, meanings: Mapping[str, Scalar]) -> Matrix:
    images = {name: meanings[name] for name in matrix.names if name in meanings}
    return matrix.substitute(images) if images else matrix


# Signals: functions of the time t, one for each component.


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
    rows = _in_texts(listed)
    if not isinstance(rows, str):
        rows = [row if isinstance(row, list) else [row] for row in rows]
    return parse_matrix(rows, known.names, where=where, functions=True)


def _in_texts(listed: Any) -> Any:
    """Return nested lists or a matrix with the texts of SymPy's expressions for these."""
    rows = listed.tolist() if hasattr(listed, "tolist") else listed
    if isinstance(rows, str):
        return rows
    return [[_text(entry) for entry in row] if isinstance(row, (list, tuple)) else _text(row) for row in rows]


def parse_in_steps(value: object, symbols: Symbols, where: str) -> Matrix:
    """Return the entries of a signal in discrete time, a column for each instant or expressions in k with powers λᵏ."""
    read = value if isinstance(value, (str, list, tuple)) or hasattr(value, "shape") else [[value]]
    if isinstance(read, str) and not read.lstrip().startswith("["):
        read = f"[{read}]" if "," in read else [[read]]
    return read_matrix(as_rows("C", _in_texts(read)), symbols.seen(value, "k"), where, variable="k", functions=True)


def _text(entry: object) -> object:
    """Return a SymPy expression as text: the grammar reads its functions."""
    if not is_sympy(entry):
        return entry
    from symobs.exact.sympy_bridge.conversion import with_plain_symbols  # noqa: PLC0415 - SymPy is there already

    return str(with_plain_symbols(entry))
