"""Stability conditions in the parameters, by Liénard and Chipart.

The roots of p(s) lie in Re s < −α where those of p(s − α) lie in Re s < 0, and in |z| < ρ where those of p(ρ z) lie in
|z| < 1.  Where the leading coefficient vanishes a root has gone to infinity: that is not stable, and no condition
holds there.  Denominators are left out: they are different from 0, or there is no polynomial.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.stability.criteria.stability import bilinear, lienard_chipart
from symobs.stability.inequalities.decision import equivalence_of
from symobs.stability.inequalities.prover import prove
from symobs.stability.inequalities.simplify import Simplified, as_inequality, cleared, simplify
from symobs.system.conditions import FACTORED_UP_TO, never_zero, sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.stability.inequalities.proof import Equivalence


#: Of lists with more terms only the shorter one is made simpler, without z3.
_COMPARED_UP_TO = 1_000


def stable_where(
    polynomial: Scalar,
    variable: str,
    signs: Mapping[str, str],
    *,
    discrete: bool = False,
    margin: Scalar | None = None,
    radius: Scalar | None = None,
) -> Simplified:
    """Return the simplest list found of polynomials positive if and only if all roots are stable, with proof.

    Roots are stable in Re s < −margin, in discrete time in |z| < radius.
    """
    lists = condition_lists(polynomial, variable, signs, discrete=discrete, margin=margin, radius=radius)
    shortest = min(lists, key=_terms)
    if _terms(shortest) > _COMPARED_UP_TO:
        return simplify(shortest, signs, ask=False)
    found = [simplify(raw, signs, ask=False) for raw in lists]
    best = min(found, key=lambda one: _length(one.positive, signs))
    return best if best.is_settled else simplify(best.equivalence.raw, signs)


def _terms(values: Sequence[Scalar]) -> int:
    return sum(value.size for value in values)


def _length(positive: Sequence[Scalar], signs: Mapping[str, str]) -> tuple[int, int, int]:
    """Return the sort key of a list: number of conditions, number not solved for a parameter, total length."""
    written = [as_inequality(v, signs, beside=[o for o in positive if o != v]) for v in positive]
    open_ = sum(left == value for (left, _, _), value in zip(written, positive, strict=True) if value.size > 2)
    return len(positive), open_, _terms(positive)


def is_stable_where(
    polynomial: Scalar,
    variable: str,
    said: Sequence[Scalar],
    signs: Mapping[str, str],
    *,
    discrete: bool = False,
    margin: Scalar | None = None,
    radius: Scalar | None = None,
    proof: Equivalence | None = None,
) -> bool:
    """Return whether it is proved that all roots are stable if and only if all of `said` are positive (trusted).

    A proof that comes along is checked against the lists computed here; else one is looked for.  Saying something that
    is seen to follow from the rest is refused.
    """
    lists = condition_lists(polynomial, variable, signs, discrete=discrete, margin=margin, radius=radius)
    if any({value for value in found if sign_of(value, signs) != "positive"} == set(said) for found in lists):
        return proof is None or proof.holds(signs)
    if any(prove(value, [other for other in said if other != value], signs) is not None for value in said):
        return False
    if proof is not None:
        return set(proof.kept) == set(said) and _is_checked(proof, lists, signs)
    found = stable_where(polynomial, variable, signs, discrete=discrete, margin=margin, radius=radius)
    if _is_equivalent(found.positive, said, signs) and _is_checked(found.equivalence, lists, signs):
        return True
    return any(_is_equivalent(raw, said, signs) for raw in lists)


def say_the_same(raw: Sequence[Scalar], said: Sequence[Scalar], signs: Mapping[str, str]) -> bool:
    """Return whether it is proved that two lists are positive at the same points (trusted)."""
    found = simplify(raw, signs, ask=False)
    same = [[_is_multiple(value, other, signs) for other in said] for value in found.positive]
    if (
        same
        and _is_checked(found.equivalence, [raw], signs)
        and all(map(any, same))
        and all(map(any, zip(*same, strict=True)))
    ):
        return True
    return _is_equivalent(raw, said, signs)


def _is_multiple(value: Scalar, other: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether two values differ by a positive factor that is defined everywhere."""
    ratio = value / other
    return sign_of(ratio, signs) == "positive" and never_zero(ratio.denominator, signs)


def _is_checked(proof: Equivalence, lists: Sequence[Sequence[Scalar]], signs: Mapping[str, str]) -> bool:
    """Return whether a proof concerns one of the lists, and holds."""
    return any(set(proof.raw) == set(map(cleared, found)) for found in lists) and proof.holds(signs)


def _is_equivalent(first: Sequence[Scalar], second: Sequence[Scalar], signs: Mapping[str, str]) -> bool:
    found = equivalence_of(first, second, signs)
    return found is not None and found.holds(signs)


def condition_lists(
    polynomial: Scalar,
    variable: str,
    signs: Mapping[str, str],
    *,
    discrete: bool = False,
    margin: Scalar | None = None,
    radius: Scalar | None = None,
) -> tuple[list[Scalar], list[Scalar]]:
    """Return both equivalent lists of Liénard and Chipart."""
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
    """Return the coefficients times ±1, or times the leading coefficient if its sign is uncertain."""
    lead = {"positive": Scalar.of(1), "negative": Scalar.of(-1)}.get(sign_of(coefficients[0], signs), coefficients[0])
    return [lead * c for c in coefficients]


def _conditions(coefficients: Sequence[Scalar], *, discrete: bool, others: bool) -> list[Scalar]:
    """Return the conditions for a positive leading coefficient, which for a bilinear image is a condition itself."""
    if not discrete:
        return lienard_chipart(coefficients, others=others)
    image = bilinear(coefficients)
    return [image[0], *lienard_chipart(image, others=others)]
