"""Equality of functions of time: exponentials, sines, cosines and square roots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, TooLarge
from symobs.exact.algebraic.rounded_decimals import decimals_in, rounds_to
from symobs.exact.core.generators import NotWritten, identities
from symobs.formula.tree import Environment, Literal, Relation
from symobs.proof.certificate.claims import verify

if TYPE_CHECKING:
    from symobs.exact import Scalar


def agrees(expected: Scalar | Matrix, found: Scalar | Matrix) -> bool:
    """Return whether the value found equals the expected one, or rounds to its decimals."""
    if not decimals_in(expected):
        return bool(expected == found)
    pairs = [(expected, found)]
    if isinstance(expected, Matrix) and isinstance(found, Matrix):
        if expected.shape != found.shape:
            return False
        pairs = list(zip(expected.entries, found.entries, strict=True))
    return all(rounds_to(one, other) for one, other in pairs)  # type: ignore[arg-type]


def functions_agree(left: Scalar | Matrix, right: Scalar | Matrix) -> bool:
    """Return whether two values are equal as functions, by common exponentials, sines and cosines.

    Decimals of the one on the left may be rounded.  Raises `TooLarge` where common ones would have too high a degree.
    """
    if decimals_in(left):
        return agrees(left, right)
    try:
        meanings, relations = identities([left, right])
    except NotWritten as error:
        raise TooLarge(str(error)) from error
    environment = Environment(coefficients=meanings, relations=relations)
    return bool(verify(Relation((Literal(left), Literal(right)), ("=",)), environment)[0])
