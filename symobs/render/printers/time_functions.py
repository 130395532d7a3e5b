"""How a function of time is spelled: as sums of coefficients times functions, an exponential before what it multiplies.

T − 1 + e^{−T};  1/(2b) (ω² − e^{−bT}(…)).  The spelling always has the scalar's value.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.kernel.generators import known
from symobs.formula import Formula, Literal, Negative, Power, Quotient, Sum
from symobs.render.printers import scalars

if TYPE_CHECKING:
    from collections.abc import Sequence

#: A function of time as a monomial: (name, exponent), the exponentials apart from the rest.
Part = tuple[tuple[str, int], ...]
_RANK = {"exp": 1, "cosh": 2, "sinh": 3, "cos": 4, "sin": 5, "RootSum": 6}


def moves(name: str) -> bool:
    """Whether a generator is an exponential, a sine or a cosine."""
    found = known(name)
    return found is not None and found.kind not in {"sqrt", "CRootOf"}


def spelled_moving(value: Scalar) -> Formula:
    """Return the formula of a value with functions of time in it."""
    below = value.denominator
    if any(moves(name) for name in below.names):
        above = value.numerator
        negative = above.terms()[0][0] < 0 and len(above.terms()) == 1
        top = scalars.spelled(-above if negative else above, "")
        fraction = Quotient(top, scalars.spelled(below, ""))
        return Negative(fraction) if negative else fraction
    separate = _grouped(_parts(value.numerator), below)
    if below.is_one:
        return separate
    whole = _over(value.numerator, below)
    return whole if scalars.size(whole) < scalars.size(separate) else separate


def _over(above: Scalar, below: Scalar) -> Formula:
    """1/d (numerator): the numerator's common monomial in the parameters goes in front as well."""
    parts = _parts(above)
    content = scalars.common_divisor([c for group in parts.values() for c in group.values()])
    if content.is_constant:
        content = Scalar.of(1)
    if content.terms()[0][0] < 0:
        content = -content
    front = scalars.spelled(content / below, "")
    inside = _grouped({e: {w: c / content for w, c in group.items()} for e, group in parts.items()}, Scalar.of(1))
    if isinstance(inside, Negative):
        return Negative(scalars.product((front, inside.operand)))
    return scalars.product((front, inside))


def _parts(above: Scalar) -> dict[Part, dict[Part, Scalar]]:
    """Return the coefficients of a numerator by exponential part and by the part that turns or grows."""
    found: dict[Part, dict[Part, Scalar]] = {}
    for coefficient, powers in above.terms():
        rest = Scalar.of(coefficient)
        fading: list[tuple[str, int]] = []
        turning: list[tuple[str, int]] = []
        for name, power in powers:
            function = known(name)
            if not moves(name):
                rest = rest * Scalar.symbol(name) ** power
            else:
                (fading if function is not None and function.kind == "exp" else turning).append((name, power))
        group = found.setdefault(tuple(fading), {})
        key = tuple(sorted(turning, key=_order))
        group[key] = group[key] + rest if key in group else rest
    return found


def _order(part: tuple[str, int]) -> tuple[int, str]:
    function = known(part[0])
    return (_RANK[function.kind] if function is not None else 0, part[0])


def _grouped(parts: dict[Part, dict[Part, Scalar]], below: Scalar) -> Formula:
    """The constant group first, then each exponential with what it multiplies."""
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
            terms.append(Negative(scalars.product((*factors, Sum(tuple(_turned(term) for term in inside))))))
        else:
            terms.append(_pulled(parts[fading], below, factors, inside))
    ordered = terms if not terms or not isinstance(terms[0], Negative) else _positive_first(terms)
    return scalars.sum_of(ordered)


def _pulled(group: dict[Part, Scalar], below: Scalar, factors: Sequence[Formula], inside: list[Formula]) -> Formula:
    """An exponential times a sum; what all coefficients share goes in front of it where that is shorter."""
    plain = scalars.product((*factors, Sum(tuple(inside))))
    content = scalars.common_divisor(list(group.values()))
    if content.is_constant:
        return plain
    rest = _sum_of({key: c / content for key, c in group.items()}, Scalar.of(1))
    front = _still(content / below)
    if len(rest) < 2 or isinstance(front, Negative):
        return plain
    shared = scalars.product((front, *factors, Sum(tuple(rest))))
    return shared if scalars.size(shared) < scalars.size(plain) else plain


def _is_pulled(terms: Sequence[Formula]) -> bool:
    return all(isinstance(term, Negative) for term in terms)


def _turned(term: Formula) -> Formula:
    return term.operand if isinstance(term, Negative) else Negative(term)


def _positive_first(terms: list[Formula]) -> list[Formula]:
    lead = next((i for i, term in enumerate(terms) if not isinstance(term, Negative)), 0)
    return [terms[lead], *terms[:lead], *terms[lead + 1 :]]


def _speed(part: Part) -> tuple[int, str]:
    text = " ".join(name for name, _ in part)
    return len(text), text


def _sum_of(group: dict[Part, Scalar], below: Scalar) -> list[Formula]:
    """The terms coefficient · function of one group, what stands still first."""
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


def _still(coefficient: Scalar) -> Formula:
    """What multiplies a function: a polynomial in the time, or constant."""
    return scalars.spelled(coefficient, "t" if "t" in coefficient.names else "T")


def _with_sign(body: Formula, functions: Sequence[Formula]) -> Formula:
    """A coefficient times functions; a coefficient 1 is not written, the minus stands in front."""
    if isinstance(body, Negative):
        return Negative(_with_sign(body.operand, functions))
    if isinstance(body, Literal) and isinstance(body.value, Scalar) and body.value.is_one:
        return scalars.product(functions)
    if isinstance(body, Quotient) and isinstance(body.numerator, Literal) and body.numerator.value == Scalar.of(1):
        return (
            Quotient(scalars.product(functions), body.denominator)
            if len(functions) == 1
            else _in_front(body, functions)
        )
    return _in_front(body, functions)


def _in_front(body: Formula, functions: Sequence[Formula]) -> Formula:
    return scalars.product((body, *functions))


def _power(name: str, exponent: int) -> Formula:
    """A power of a function; e^{x} to a power is one exponential again."""
    function = known(name)
    if function is not None and function.kind == "exp" and exponent != 1:
        from symobs.exact.kernel.generators import function as applied  # noqa: PLC0415 - the name is used for values here

        return Literal(applied("exp", function.argument * exponent))
    base = Literal(Scalar.symbol(name))
    return base if exponent == 1 else Power(base, exponent)
