"""Two values as functions: equal where their exponentials, sines, cosines and square roots are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.certificate import verify
from symobs.exact.functions import identities
from symobs.formula import Environment, Literal, Relation

if TYPE_CHECKING:
    from symobs.exact import Matrix, Scalar


def functions_agree(left: Scalar | Matrix, right: Scalar | Matrix) -> bool:
    """Tell whether two values are equal as functions: brought to common exponentials, sines and cosines."""
    meanings, relations = identities([left, right])
    environment = Environment(coefficients=meanings, relations=relations)
    return bool(verify(Relation((Literal(left), Literal(right)), ("=",)), environment)[0])
