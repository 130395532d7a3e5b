"""Scalars and matrices as formulas; functions of time as sums of coefficients times functions, exponentials in front.

T − 1 + e^{−T};  1/(2b) (ω² − e^{−bT}(…)).  The formula always has the value of the scalar.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import accumulate
from math import lcm
from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE, Matrix, Scalar
from symobs.exact.algebraic.root_sum import JoinedSum, RootSum
from symobs.exact.core.generators import exponentials_in, function_named, generator
from symobs.exact.core.ring import number_of
from symobs.formula.tree import Block, Formula, Literal, Negative, Numeral, Power, Product, Quotient, Sum
from symobs.pages.printers.rational_formula import common_divisor, is_leaf, product, rational_formula, size, sum_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from symobs.exact.core.generators import Function
    from symobs.pages.printers.glyphs import Rules

#: A common denominator of more terms, or more bits, is not put in front of a matrix.
FRONT_UP_TO = 40
FRONT_BITS = 200

#: A function of time as a monomial: (name, exponent), the exponentials apart from the rest.
Part = tuple[tuple[str, int], ...]
_RANK = {"exp": 1, "cosh": 2, "sinh": 3, "cos": 4, "sin": 5, "RootSum": 6}
_RANK |= {"log": 5, "asin": 5, "acos": 5, "atan": 5, "abs": 5, "sign": 5}
_RANK |= {"power": 7, "re": 8, "im": 9, "KroneckerDelta": 10}


def is_time_function(name: str) -> bool:
    """Return whether a generator is an exponential, a sine or a cosine."""
    found = function_named(name)
    return found is not None and found.kind not in {"sqrt", "CRootOf", "RootPart"}


def wave(formula: Formula) -> Function | None:
    """Return the sine or cosine, also hyperbolic, that a formula is."""
    if not isinstance(formula, Literal) or not isinstance(formula.value, Scalar) or not is_leaf(formula.value):
        return None
    found = next(map(function_named, formula.value.names), None)
    return found if found is not None and found.kind in {"sin", "cos", "sinh", "cosh"} else None


@lru_cache(maxsize=4096)
def formula_of(value: Scalar, variable: str) -> Formula:
    """Return the formula of a scalar, collected in the powers of `variable`."""
    if not is_leaf(value) and any(is_time_function(name) for name in value.names):
        return _time_function(value)
    return rational_formula(value, variable)


@lru_cache(maxsize=1024)
def formula_of_matrix(matrix: Matrix, variable: str) -> Formula:
    """Return the matrix, or 1/d times one without fractions where d is the denominator of most of its entries."""
    denominators = [entry.denominator for entry in matrix.entries if not entry.is_zero]
    if len(denominators) < 2 or any(below.is_one for below in denominators):
        return Literal(matrix)
    if len(denominators) == 2 and denominators[0] != denominators[1] and not denominators[0].is_constant:
        return Literal(matrix)  # [0; 1/M; 0; −1/(lM)] as it was typed
    common = _least_common_multiple(dict.fromkeys(denominators))
    if common is None or 2 * denominators.count(common) < len(denominators):
        return Literal(matrix)
    front, cleared = formula_of(Scalar.of(1) / common, variable), matrix * common
    if exponentials_in(common).keys() & cleared.names:
        return Literal(matrix)  # 1 − e^{−2} in an entry, not e² − 1 behind e^{−2}
    inside = sum(size(formula_of(entry, variable)) for entry in cleared.entries)
    kept = sum(size(formula_of(entry, variable)) for entry in matrix.entries)
    return Product((front, Literal(cleared))) if size(front) + inside < kept else Literal(matrix)


def partitioned(rows: Sequence[Sequence[Formula]]) -> tuple[list[list[Formula]], Rules] | None:
    """Return the entries of blocks that are all matrices of values, and the rows and columns that end a block."""
    if len(rows) == len(rows[0]) == 1:
        return None
    tables = [[found for block in row if (found := _entries_of(block))] for row in rows]
    if [len(row) for row in tables] != [len(row) for row in rows]:
        return None
    entries = [[entry for block in row for entry in block[line]] for row in tables for line in range(len(row[0]))]
    heights, widths = [len(row[0]) for row in tables], [len(block[0]) for block in tables[0]]
    return entries, (tuple(accumulate(heights))[:-1], tuple(accumulate(widths))[:-1])


def _entries_of(block: Formula) -> Sequence[Sequence[Formula]]:
    """Return the entries of a matrix of values, exact or in decimals; nothing for other blocks."""
    match block:
        case Literal(Matrix() as value) if 0 not in value.shape:
            return [[Literal(entry) for entry in row] for row in value.rows]
        case Block(rows) if all(is_number(entry) for row in rows for entry in row):
            return rows
    return ()


def is_number(formula: Formula) -> bool:
    """Return whether a formula is a value of one entry, exact or in decimals, or a sum of such values."""
    inner = formula.operand if isinstance(formula, Negative) else formula
    if isinstance(inner, Sum):
        return all(map(is_number, inner.terms))
    return isinstance(inner, Numeral) or (isinstance(inner, Literal) and isinstance(inner.value, Scalar))


def is_table(formula: Formula) -> bool:
    """Return whether a formula is a matrix of values, which is printed in brackets: one of a single entry is a number."""
    return isinstance(formula, Literal) and isinstance(formula.value, Matrix) and formula.value.shape != (1, 1)


def is_unit(formula: Formula) -> bool:
    """Return whether a formula is the identity matrix of one row, which a product leaves out."""
    return isinstance(formula, Literal) and isinstance(formula.value, Matrix) and formula.value == Matrix.identity(1)


def _least_common_multiple(values: Iterable[Scalar]) -> Scalar | None:
    """Return the least common multiple, unless it grows too long to be written."""
    multiple, values = Scalar.of(1), tuple(values)
    if all(value.is_constant for value in values):
        whole = lcm(*(int(number_of(value.numerator_part)) for value in values))
        return Scalar.of(whole) if whole.bit_length() <= FRONT_BITS else None
    for value in values:
        multiple = multiple * (value / multiple).numerator
        largest = max(abs(coefficient) for coefficient, _ in multiple.terms())
        if multiple.size > FRONT_UP_TO or largest.bit_length() > FRONT_BITS:
            return None
    return multiple


def _time_function(value: Scalar) -> Formula:
    """Return the formula of a value that contains functions of time."""
    below = value.denominator
    if any(is_time_function(name) for name in below.names):
        if (raised := _raised(value)) is not None:
            return raised
        above = value.numerator
        negative = all(coefficient < 0 for coefficient, _ in above.terms())
        above = -above if negative else above
        if negative and any(
            coefficient < 0 for coefficient, _ in below.terms()
        ):  # (1 + e)/(2 − e) for −(1 + e)/(e − 2)
            negative, below = False, -below
        fraction = Quotient(formula_of(above, ""), formula_of(below, ""))
        return Negative(fraction) if negative else fraction
    separate = _grouped({fading: _joined_sums(group) for fading, group in _parts(value.numerator).items()}, below)
    if below.is_one:
        return separate
    whole = _over(value.numerator, below)
    return whole if size(whole) < size(separate) else separate


def _raised(value: Scalar) -> Formula | None:
    """Return 1 − e^{−T} for (e^T − 1)/e^T: a value whose denominator has exponentials as factors only."""
    falling = exponentials_in(value.denominator)
    rest = value.denominator
    for name, power in falling.items():
        rest = rest / Scalar.symbol(name) ** power
    if not falling or any(map(is_time_function, rest.names)):
        return None
    parts: dict[Part, dict[Part, Scalar]] = {}
    for fading, group in _parts(value.numerator).items():
        powers = dict(fading)
        shifted = {name: powers.get(name, 0) - falling.get(name, 0) for name in {*powers, *falling}}
        parts[tuple(sorted((name, power) for name, power in shifted.items() if power))] = group
    separate = _grouped(parts, rest)
    if rest.is_one:
        return separate
    whole = product((formula_of(1 / rest, ""), _grouped(parts, Scalar.of(1))))
    return whole if size(whole) < size(separate) else separate


def separate_formula(value: Scalar) -> Formula:
    """Return a value that contains functions of time, term by term with coefficients, each of them a term of the value."""
    if any(is_time_function(name) for name in value.denominator.names):
        return _time_function(value)
    return _grouped(_parts(value.numerator), value.denominator)


def _over(above: Scalar, below: Scalar) -> Formula:
    """Return 1/d (numerator) with the content of the numerator in the parameters in front."""
    parts = _parts(above)
    content = common_divisor([c for group in parts.values() for c in group.values()])
    if content.is_constant:
        content = Scalar.of(1)
    if content.terms()[0][0] < 0:
        content = -content
    front = formula_of(content / below, "")
    inside = _grouped({e: {w: c / content for w, c in group.items()} for e, group in parts.items()}, Scalar.of(1))
    if isinstance(inside, Negative):
        return Negative(product((front, inside.operand)))
    return product((front, inside))


def _parts(above: Scalar) -> dict[Part, dict[Part, Scalar]]:
    """Return the coefficients of a numerator by exponential part and by the part that turns or grows."""
    found: dict[Part, dict[Part, Scalar]] = {}
    for coefficient, powers in above.terms():
        rest = Scalar.of(coefficient)
        fading: list[tuple[str, int]] = []
        turning: list[tuple[str, int]] = []
        for name, power in powers:
            function = function_named(name)
            if not is_time_function(name):
                rest = rest * Scalar.symbol(name) ** power
            else:
                (fading if function is not None and function.kind == "exp" else turning).append((name, power))
        group = found.setdefault(tuple(fading), {})
        key = tuple(sorted(turning, key=_order))
        group[key] = group[key] + rest if key in group else rest
    return found


def _order(part: tuple[str, int]) -> tuple[int, str]:
    function = function_named(part[0])
    return (_RANK[function.kind] if function is not None else 0, part[0])


def _grouped(parts: dict[Part, dict[Part, Scalar]], below: Scalar) -> Formula:
    """Return the constant terms first, then each exponential with its factor."""
    terms: list[Formula] = []
    for fading in sorted(parts, key=lambda part: (len(part) > 0, _speed(part))):
        inside = _sum_of(parts[fading], below)
        if not fading:
            terms += inside
            continue
        factors = [_power(name, power) for name, power in fading]
        if len(parts[fading]) == 1 and len(inside) == 1:
            ((turning, coefficient),) = parts[fading].items()
            terms.append(_with_sign(_still(coefficient / below), [*factors, *(_power(*item) for item in turning)]))
        elif _is_pulled(inside):
            terms.append(Negative(product((*factors, Sum(tuple(_turned(term) for term in inside))))))
        else:
            terms.append(_pulled(parts[fading], below, factors, inside))
    ordered = terms if not terms or not isinstance(terms[0], Negative) else _positive_first(terms)
    return sum_of(ordered)


def _pulled(group: dict[Part, Scalar], below: Scalar, factors: Sequence[Formula], inside: list[Formula]) -> Formula:
    """Return an exponential times a sum, the common divisor of the coefficients in front where that is shorter."""
    plain = product((*factors, Sum(tuple(inside))))
    content = common_divisor(list(group.values()))
    if content.is_constant:
        return plain
    rest = _sum_of({key: c / content for key, c in group.items()}, Scalar.of(1))
    front = _still(content / below)
    if len(rest) < 2 or isinstance(front, Negative):
        return plain
    shared = product((front, *factors, Sum(tuple(rest))))
    return shared if size(shared) < size(plain) else plain


def _is_pulled(terms: Sequence[Formula]) -> bool:
    return all(isinstance(term, Negative) for term in terms)


def _turned(term: Formula) -> Formula:
    return term.operand if isinstance(term, Negative) else Negative(term)


def _positive_first(terms: list[Formula]) -> list[Formula]:
    lead = next((i for i, term in enumerate(terms) if not isinstance(term, Negative)), 0)
    return [terms[lead], *terms[:lead], *terms[lead + 1 :]]


def _speed(part: Part) -> tuple[int, str, int]:
    text = " ".join(name for name, _ in part)
    return len(text), text, sum(power for _, power in part)


def _sum_of(group: dict[Part, Scalar], below: Scalar) -> list[Formula]:
    """Return the terms coefficient · function of one group, constant ones first."""
    terms: list[Formula] = []
    for turning in sorted(group, key=lambda part: (len(part), [_order(item) for item in part])):
        coefficient = group[turning] / below
        body = _still(coefficient)
        functions = [_power(name, power) for name, power in turning]
        if not functions:
            terms += body.terms if isinstance(body, Sum) else (body,)
        else:
            terms.append(_with_sign(body, functions))
    return terms if not terms or not isinstance(terms[0], Negative) else _positive_first(terms)


def _joined_sums(group: dict[Part, Scalar]) -> dict[Part, Scalar]:
    """Return the coefficients with one sum Σ (2 + λ) e^{λt}/q′(λ) for several over the same roots."""
    over: dict[tuple[Scalar, Scalar], list[tuple[Part, RootSum]]] = {}
    for part in group:
        found = function_named(part[0][0]) if len(part) == 1 and part[0][1] == 1 else None
        if isinstance(found, RootSum):
            over.setdefault((found.polynomial, found.argument), []).append((part, found))
    joined = dict(group)
    for (polynomial, argument), members in over.items():
        if len(members) > 1:
            root = Scalar.symbol(EIGENVALUE)
            above = sum((joined.pop(part) * root**found.power for part, found in members), Scalar.of(0))
            content, _ = above.factors()
            whole = JoinedSum("RootSum", argument, polynomial, 0, above / content)
            joined[((next(iter(whole.value.names)), 1),)] = content
    return joined


def _still(coefficient: Scalar) -> Formula:
    """Return a coefficient: a polynomial in the time, or a constant."""
    return formula_of(coefficient, "t" if "t" in coefficient.names else "T")


def _with_sign(body: Formula, functions: Sequence[Formula]) -> Formula:
    """Return a coefficient times functions, the coefficient 1 left out and the minus in front."""
    if isinstance(body, Negative):
        return Negative(_with_sign(body.operand, functions))
    if isinstance(body, Literal) and isinstance(body.value, Scalar) and body.value.is_one:
        return product(functions)
    if isinstance(body, Quotient) and isinstance(body.numerator, Literal) and body.numerator.value == Scalar.of(1):
        return Quotient(product(functions), body.denominator) if len(functions) == 1 else _in_front(body, functions)
    return _in_front(body, functions)


def _in_front(body: Formula, functions: Sequence[Formula]) -> Formula:
    return product((body, *functions))


def _power(name: str, exponent: int) -> Formula:
    """Return a power of a function; e^{x} to a power is one exponential again."""
    function = function_named(name)
    if function is not None and function.kind == "exp" and exponent != 1:
        return Literal(generator("exp", function.argument * exponent))
    base = Literal(Scalar.symbol(name))
    return base if exponent == 1 else Power(base, exponent)


def factors(formula: Formula, variable: str) -> list[Formula]:
    """Return the factors of nested products, values spelled out."""
    match formula:
        case Product(parts):
            shown = [part for part in parts if not is_unit(part)] or parts[:1]
            return [factor for part in shown for factor in factors(part, variable)]
        case Literal(Matrix(shape=(1, 1)) as table):
            return factors(Literal(table[0, 0]), variable)
        case Literal(Scalar() as value) if not is_leaf(value):
            written = formula_of(value, variable)
            return factors(written, variable) if isinstance(written, Product) else [formula]
        case Literal(Matrix() as table):
            opened = formula_of_matrix(table, variable)
            return list(opened.factors) if isinstance(opened, Product) else [formula]
        case _:
            return [formula]
