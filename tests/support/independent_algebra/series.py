"""Numbers that move: Taylor coefficients in one generator, exact where they can be, else with 60 digits.

exp, cos, sin, cosh, sinh and square roots of such numbers follow from their differential equations, so a derivative is a
shift of coefficients and nothing is known of the kernel's rules.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mpmath.ctx_mp import MPContext

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

CONTEXT = MPContext()
CONTEXT.dps = 60
#: Values that differ by less, beside their size, are equal: sums of what random points make lose far fewer digits.
TOLERANCE = CONTEXT.mpf(10) ** -30


def digits(value: Any) -> Any:
    """Return an exact number with 60 digits, any other as it is."""
    return CONTEXT.mpf(value.numerator) / value.denominator if isinstance(value, (int, Fraction)) else value


class Series(Fraction):
    """Σ parts[k] hᵏ, cut off; a constant where there is one part."""

    parts: list[Any]

    @classmethod
    def make(cls, parts: Sequence[Any]) -> Fraction:
        """Return the series; an exact constant is a fraction."""
        if len(parts) == 1 and isinstance(parts[0], (int, Fraction)):
            return Fraction(parts[0])
        found = super().__new__(cls, 0)
        found.parts = list(parts)
        return found

    @classmethod
    def moving(cls, value: Any, length: int) -> Fraction:
        """Return value + h."""
        return cls.make([value, Fraction(1), *([Fraction(0)] * (length - 2))])

    def __add__(self, other: Any) -> Any:
        return self.make([_sum(a, b) for a, b in _pairs(self, other)])

    def __mul__(self, other: Any) -> Any:
        pairs = _pairs(self, other)
        return self.make(
            [_total(_product(pairs[i][0], pairs[k - i][1]) for i in range(k + 1)) for k in range(len(pairs))]
        )

    def __truediv__(self, other: Any) -> Any:
        return _quotient(self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _quotient(other, self)

    def __pow__(self, exponent: Any) -> Any:
        total: Any = Fraction(1)
        for _ in range(exponent):
            total = total * self
        return total

    def __neg__(self) -> Any:
        return self * Fraction(-1)

    def __sub__(self, other: Any) -> Any:
        return self + Fraction(-1) * other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __bool__(self) -> bool:
        return self != Fraction(0)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (int, Fraction)) and all(_near(a, b) for a, b in _pairs(self, other))

    def __repr__(self) -> str:
        return f"Series({', '.join(CONTEXT.nstr(digits(part), 10) for part in self.parts)})"

    __hash__ = None  # type: ignore[assignment]


#: A number no fraction is; its name means nothing else.
PI = Series.make([+CONTEXT.pi])


def _pairs(left: Any, right: Any) -> list[tuple[Any, Any]]:
    """Return the coefficients beside each other, those of a constant filled up with zeros."""
    a, b = (list(value.parts) if isinstance(value, Series) else [Fraction(value)] for value in (left, right))
    length = max(len(a), len(b))
    assert {len(a), len(b)} <= {1, length}, "both are series in one generator"
    a, b = ([*part, *([Fraction(0)] * (length - len(part)))] for part in (a, b))
    return list(zip(a, b, strict=True))


def _sum(a: Any, b: Any) -> Any:
    return a + b if isinstance(a, Fraction) and isinstance(b, Fraction) else digits(a) + digits(b)


def _product(a: Any, b: Any) -> Any:
    return a * b if isinstance(a, Fraction) and isinstance(b, Fraction) else digits(a) * digits(b)


def _total(values: Any) -> Any:
    total: Any = Fraction(0)
    for value in values:
        total = _sum(total, value)
    return total


def _near(a: Any, b: Any) -> bool:
    if isinstance(a, Fraction) and isinstance(b, Fraction):
        return bool(a == b)
    a, b = digits(a), digits(b)
    return bool(abs(a - b) <= TOLERANCE * (1 + abs(a) + abs(b)))


def _quotient(above: Any, below: Any) -> Any:
    pairs = _pairs(above, below)
    lead = pairs[0][1]
    if _near(lead, Fraction(0)):
        raise ZeroDivisionError
    found: list[Any] = []
    for k, (part, _) in enumerate(pairs):
        rest = _sum(part, _product(Fraction(-1), _total(_product(found[i], pairs[k - i][1]) for i in range(k))))
        found.append(
            rest / lead if isinstance(rest, Fraction) and isinstance(lead, Fraction) else digits(rest) / digits(lead)
        )
    return Series.make(found)


def rate(value: Any) -> Any:
    """Return the derivative of a number, or of every number in a table."""
    if isinstance(value, list):
        return [rate(entry) for entry in value]
    if not isinstance(value, Series) or len(value.parts) == 1:
        return Fraction(0)
    return Series.make([_product(part, Fraction(k)) for k, part in enumerate(value.parts) if k])


#: kind → its value at a number, its derivative as (sign, kind).
_FUNCTIONS: dict[str, tuple[Callable[[Any], Any], tuple[int, str]]] = {
    "exp": (CONTEXT.exp, (1, "exp")),
    "sin": (CONTEXT.sin, (1, "cos")),
    "cos": (CONTEXT.cos, (-1, "sin")),
    "sinh": (CONTEXT.sinh, (1, "cosh")),
    "cosh": (CONTEXT.cosh, (1, "sinh")),
}


def applied(kind: str, argument: Any) -> Any:
    """Return exp, cos, sin, cosh, sinh or sqrt of a number: f(a)' = f'(a) a', coefficient by coefficient."""
    parts = argument.parts if isinstance(argument, Series) else [argument]
    if kind == "sqrt":
        assert len(parts) == 1, "a root of what moves is not written"
        return Series.make([CONTEXT.sqrt(digits(parts[0]))])
    found: dict[str, list[Any]] = {}
    for name in dict.fromkeys((kind, _FUNCTIONS[kind][1][1])):
        at_zero = Fraction(0 if name in {"sin", "sinh"} else 1)
        exact = isinstance(parts[0], (int, Fraction)) and parts[0] == 0
        found[name] = [at_zero if exact else _FUNCTIONS[name][0](digits(parts[0]))]
    for k in range(1, len(parts)):
        new = {}
        for name in found:
            sign, other = _FUNCTIONS[name][1]
            whole = _total(_product(parts[i] * i, found[other][k - i]) for i in range(1, k + 1))
            new[name] = _product(whole, Fraction(sign, k))
        for name, part in new.items():
            found[name].append(part)
    return Series.make(found[kind])


def root_sum(polynomial: Sequence[Fraction], power: int, argument: Any) -> Any:
    """Return Σ λᵖ e^{λa} / q′(λ) over the roots λ of q, highest coefficient of q first; its derivative has the power p + 1."""
    parts = argument.parts if isinstance(argument, Series) else [argument]
    roots = CONTEXT.polyroots([digits(c) for c in polynomial], maxsteps=500, extraprec=400)
    degree = len(polynomial) - 1
    slope = [digits(c) * (degree - k) for k, c in enumerate(polynomial[:-1])]
    rows: list[list[Any]] = []
    for further in reversed(range(len(parts))):
        terms = (r ** (power + further) * CONTEXT.exp(r * digits(parts[0])) / CONTEXT.polyval(slope, r) for r in roots)
        row = [CONTEXT.re(sum(terms))]
        for k in range(1, len(parts) - further):
            whole = _total(_product(parts[i] * i, rows[-1][k - i]) for i in range(1, k + 1))
            row.append(_product(whole, Fraction(1, k)))
        rows.append(row)
    return Series.make(rows[-1])
