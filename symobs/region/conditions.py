"""For which parameters are all roots stable: the polynomials that must be positive, by Liénard and Chipart.

The roots of p(s) lie in Re s < −α where those of p(s − α) lie in Re s < 0, and in |z| < ρ where those of p(ρ z) lie in
|z| < 1.  Where the leading coefficient vanishes a root has gone to infinity: that is not stable, and no condition
holds there.  Denominators are left out: they are different from 0, or there is no polynomial.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.conditions import FACTORED_UP_TO, sign_of
from symobs.exact import Scalar
from symobs.region.simplify import Simplified, simplify
from symobs.stability import bilinear, lienard_chipart

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


def stable_where(
    polynomial: Scalar,
    variable: str,
    signs: Mapping[str, str],
    *,
    discrete: bool = False,
    margin: Scalar | None = None,
    radius: Scalar | None = None,
) -> Simplified:
    """Return the simplest list of polynomials found that are positive exactly where all roots are stable, with proof.

    Roots are stable in Re s < −margin, in discrete time in |z| < radius.
    """
    lists = condition_lists(polynomial, variable, signs, discrete=discrete, margin=margin, radius=radius)
    found = [simplify(raw, signs, ask=False) for raw in lists]
    best = min(found, key=_length)
    return best if best.is_settled else simplify(best.equivalence.raw, signs)


def _length(found: Simplified) -> tuple[int, int]:
    return len(found.positive), sum(value.size for value in found.positive)


def stability_conditions(
    polynomial: Scalar,
    variable: str,
    signs: Mapping[str, str],
    *,
    discrete: bool = False,
    margin: Scalar | None = None,
    radius: Scalar | None = None,
) -> list[Scalar]:
    """Return the polynomials that are positive exactly where all roots lie in Re s < −margin, |z| < radius."""
    lists = condition_lists(polynomial, variable, signs, discrete=discrete, margin=margin, radius=radius)
    return min(lists, key=lambda found: sum(value.size for value in found))


def condition_lists(
    polynomial: Scalar,
    variable: str,
    signs: Mapping[str, str],
    *,
    discrete: bool = False,
    margin: Scalar | None = None,
    radius: Scalar | None = None,
) -> tuple[list[Scalar], list[Scalar]]:
    """Return both lists of Liénard and Chipart, each of which says the same."""
    moved, besides = _moved(polynomial, variable, margin=margin, radius=radius), list[Scalar]()
    if radius is not None and sign_of(radius, signs) != "positive":
        besides.append(radius.numerator * radius.denominator)
    parts, content = _parts(moved.numerator, variable)
    besides += [factor**2 for factor in content if sign_of(factor, signs) not in {"positive", "negative", "nonzero"}]
    oriented = [_with_positive_lead(part.coefficients(variable), signs) for part in parts]
    first, second = (
        [*besides, *(c for part in oriented for c in _conditions(part, discrete=discrete, others=others))]
        for others in (False, True)
    )
    return first, second


def _moved(polynomial: Scalar, variable: str, *, margin: Scalar | None, radius: Scalar | None) -> Scalar:
    place = Scalar.symbol(variable)
    if margin is not None:
        polynomial = polynomial.substitute({variable: place - margin})
    return polynomial if radius is None else polynomial.substitute({variable: place * radius})


def _parts(polynomial: Scalar, variable: str) -> tuple[list[Scalar], list[Scalar]]:
    """Return the distinct factors with roots, and the factors without; a long polynomial is not factored."""
    factors = [f for f, _ in polynomial.factors()[1]] if polynomial.size <= FACTORED_UP_TO else [polynomial]
    with_roots = [factor for factor in factors if factor.degree(variable) > 0]
    return with_roots, [factor for factor in factors if factor.degree(variable) <= 0]


def _with_positive_lead(coefficients: Sequence[Scalar], signs: Mapping[str, str]) -> list[Scalar]:
    """Return the coefficients times ±1, or times the leading one where its sign is not certain."""
    lead = {"positive": Scalar.of(1), "negative": Scalar.of(-1)}.get(sign_of(coefficients[0], signs), coefficients[0])
    return [lead * c for c in coefficients]


def _conditions(coefficients: Sequence[Scalar], *, discrete: bool, others: bool) -> list[Scalar]:
    """Return what must be positive where the leading coefficient is; of the bilinear image it has to be too."""
    if not discrete:
        return lienard_chipart(coefficients, others=others)
    image = bilinear(coefficients)
    return [image[0], *lienard_chipart(image, others=others)]
