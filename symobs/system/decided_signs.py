"""Values with |x|, signs and squares under roots decided by the signs of letters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.core.generators import all_roots, functions_in, root_of
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping

_SIDES = {"positive": 1, "nonnegative": 1, "negative": -1, "nonpositive": -1}


def by_signs(value: Scalar, signs: Mapping[str, str]) -> Scalar:
    """Return a value with |x|, signs and squares under roots decided by the signs of the parameters."""
    for f in sorted(functions_in([value]), key=lambda f: f.text):
        if f.kind in {"abs", "sign"} and (sign := sign_of(f.argument, signs)) in {"positive", "negative", "zero"}:
            side = {"positive": 1, "negative": -1, "zero": 0}[sign]
            value = value.substitute({f.name: f.argument * side if f.kind == "abs" else Scalar.of(side)})
    for root in sorted(all_roots(value), key=lambda root: root.text):
        unit, factors = root.argument.factors()
        front, inside = Scalar.of(1), unit
        for factor, power in factors:
            half, rest = divmod(power, 2)
            side = _SIDES.get(sign_of(factor, signs), 0)
            if half % 2 and not side:
                half, rest = 0, power
            front = front * (factor * (side or 1)) ** half
            inside = inside * factor**rest
        if not front.is_one or root.argument != inside:
            value = value.substitute({root.name: front * root_of(inside)})
    return value


def without_squares(value: Scalar) -> Scalar:
    """Return a value in which no square root stands squared: √a² is a."""
    for root in sorted(all_roots(value), key=lambda root: root.text):
        parts = []
        for polynomial in (value.numerator, value.denominator):
            powers = [*reversed(polynomial.coefficients(root.name))] if root.name in polynomial.names else [polynomial]
            terms = (c * root.argument ** (k // 2) * root.value ** (k % 2) for k, c in enumerate(powers))
            parts.append(sum(terms, Scalar.of(0)))
        value = parts[0] / parts[1]
    return value
