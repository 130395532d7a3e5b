"""Whether an exponential that a sentence compares is that of the letters the sentence speaks of (trusted).

The inequality alone would be true of many a number: a pair of poles overshoots by exp(−π σ/ω), and by no other.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.functions import PI, function
from symobs.formula import Exact, evaluate

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from symobs.formula import Environment, Relation


def _one_higher(value: Fraction) -> Fraction:
    """Return a positive number with its third digit one higher.  Raises ValueError for another number."""
    if value <= 0:
        raise ValueError(value)
    unit = Fraction(1)
    while value < 100 * unit:
        unit /= 10
    while value >= 1000 * unit:
        unit *= 10
    return value + unit


#: What e is raised to in the relation of a sentence, from the values of the letters.
EXPONENTS: dict[str, Callable[[Mapping[str, Scalar]], Scalar]] = {
    "decayed": lambda of: -of["sigma_d"] * of["T_s"],
    "overshoot_held": lambda of: -Scalar.symbol(PI) * of["sigma_d"] / of["omega_d"],
    "overshoot_close": lambda of: -Scalar.symbol(PI) / _one_higher((of["omega_d"] / of["sigma_d"]).fraction()),
}


def is_its_own(key: str, relation: Relation, environment: Environment) -> bool:
    """Tell whether the relation of a sentence begins with the exponential that the sentence speaks of."""
    told = evaluate(relation.members[0], environment, Exact(environment))
    return bool(told == function("exp", EXPONENTS[key](environment.values)))  # type: ignore[arg-type]
